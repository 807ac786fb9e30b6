// Which kinds of solvers a verdict is for.
#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <string>

#include "geom/base/error.h"
#include "scripting/values/check_options.h"

namespace sterna::scripting {
namespace {

TEST(Consumers, SolversOfAListCountTogether) {
  EXPECT_EQ(consumers_of_solvers("su2", {}, "--for"), k_node_centred_alone);
  EXPECT_EQ(consumers_of_solvers("openfoam,fluent", {}, "--for"), k_cell_centred_alone);
  EXPECT_EQ(consumers_of_solvers("tau,openfoam", k_node_centred_alone, "--for"), Consumers{});
  EXPECT_EQ(consumers_of_solvers("automatic", k_node_centred_alone, "--for"), k_node_centred_alone);
  for (const char* const wrong : {"su3", "", "su2,,openfoam"}) EXPECT_THROW(consumers_of_solvers(wrong, {}, "--for"), Error) << wrong;
}

TEST(Consumers, FormatsCountTogether) {
  EXPECT_EQ(consumers_of_files(std::array<std::filesystem::path, 1>{"a.su2"}), k_node_centred_alone);
  EXPECT_EQ(consumers_of_files(std::array<std::filesystem::path, 1>{"case.foam"}), k_cell_centred_alone);
  EXPECT_EQ(consumers_of_files(std::array<std::filesystem::path, 2>{"a.su2", "case.foam"}), Consumers{});
  EXPECT_EQ(consumers_of_files(std::array<std::filesystem::path, 1>{"a.cgns"}), Consumers{});
  EXPECT_EQ(consumers_of_files({}), Consumers{});
}

/// The names stand in one table; the help of the option is a text of its own.
TEST(Consumers, TheHelpNamesEverySolver) {
  CheckSettings settings;
  std::string help;
  for (const Option& option : options_of(settings))
    if (option.name == "solvers") help = option.help;
  ASSERT_FALSE(help.empty());
  std::istringstream names(known_solvers());
  for (std::string name; names >> name;) {
    if (name.back() == ',') name.pop_back();
    EXPECT_NE(help.find(name), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace sterna::scripting
