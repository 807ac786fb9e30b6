// Which kinds of solvers a verdict is for.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "geom/base/error.h"
#include "scripting/values/check_options.h"
#include "tests/scripting/script_fixture.h"

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

std::string contradiction(const CheckSettings& settings, const GateTable& limits = {}, Consumers usual = {}) {
  const auto found = settings.contradiction(limits, usual, CheckSettings::k_command_names);
  if (!found) return {};
  EXPECT_FALSE(found->remedy.empty());
  return found->problem;
}

TEST(Consumers, VerdictNeedsItsGates) {
  for (const char* const solvers : {"openfoam", "su2,fluent", "all", "cell-centred"}) {
    CheckSettings settings{.cell_centred = false, .strict = true, .solvers = solvers};
    const std::string problem = contradiction(settings);
    EXPECT_NE(problem.find("--no-cell-centred switches off"), std::string::npos) << problem;
    EXPECT_NE(problem.find("--for \"" + std::string(solvers) + "\""), std::string::npos) << problem;
    EXPECT_THROW(settings.to_options(), Error);
    settings.cell_centred = true;
    EXPECT_EQ(contradiction(settings), "");
  }
  EXPECT_EQ(contradiction({.cell_centred = false, .solvers = "su2"}), "");
  EXPECT_NE(contradiction({.cell_centred = false}, {}, k_cell_centred_alone).find("only cell-centred solvers read the format"), std::string::npos);
  EXPECT_NE(contradiction({.quality = false, .strict = true}), "");
  EXPECT_NE(contradiction({.quality = false, .solvers = "su2"}), "");
  EXPECT_EQ(contradiction({.quality = false}), "");
  GateTable limits;
  limits[Measure::non_orthogonality].hard = 1.0;
  EXPECT_NE(contradiction({.cell_centred = false, .solvers = "su2"}, limits).find("non_orthogonality"), std::string::npos);
}

TEST(Consumers, AutomaticVerdictLeavesOutSwitchedOffGates) {
  EXPECT_EQ(CheckSettings{.cell_centred = false}.to_options().consumers, k_node_centred_alone);
  EXPECT_EQ(CheckSettings{}.to_options().consumers, Consumers{});
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

class Rounding : public ScriptFixture {};

TEST_F(Rounding, ManifestOfSinglePrecisionHasNoQualityOfDoublePrecision) {
  // A box 100 m from the origin: single precision steps by 8e-6 m there, and the first cells are 1e-4 m high.
  run("local wall = surface_mesh{ box{ {100, 100, 100}, {101, 101, 101}, name = 'body' }, max_edge = 0.5 } local mesh = volume_mesh{ wall, layers = 3, "
      "first_height = 1e-4, farfield = sphere{ radius = 10 } } mesh:check{} mesh:write(" +
      out("far.lb4.ugrid") + ") mesh:write(" + out("far.lb8.ugrid") + ")");
  EXPECT_NE(log_.find("% of the length of their edge"), std::string::npos) << log_;
  const nlohmann::json rounded = nlohmann::json::parse(text_of("far.lb4.ugrid.json"))["quality"];
  EXPECT_EQ(rounded["verdict"], "not checked");
  EXPECT_NE(rounded["reason"].get<std::string>().find("single precision moves nodes"), std::string::npos) << rounded.dump();
  EXPECT_TRUE(rounded["measures"].empty());
  const nlohmann::json exact = nlohmann::json::parse(text_of("far.lb8.ugrid.json"))["quality"];
  EXPECT_NE(exact["verdict"], "not checked");
  EXPECT_FALSE(exact["measures"].empty());
}

}  // namespace
}  // namespace sterna::scripting
