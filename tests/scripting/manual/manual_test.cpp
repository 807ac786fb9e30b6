// docs/lua.md equals the output of the program, and its examples run.
#include <fstream>
#include <iterator>

#include "scripting/interpreter/script_help.h"
#include "scripting/interpreter/script_manual.h"
#include "scripting/interpreter/script_state.h"
#include "scripting/lua/script_check.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

/// A point with a target size, for size_samples.
constexpr const char* k_sizes_vtu =
    R"(<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"><UnstructuredGrid><Piece NumberOfPoints="1" NumberOfCells="1">
<PointData><DataArray type="Float64" Name="size" format="ascii">0.5</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">2 0 0</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0</DataArray><DataArray type="Int64" Name="offsets" format="ascii">1</DataArray><DataArray type="UInt8" Name="types" format="ascii">1</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
)";

TEST(Manual, IsWhatTheProgramPrints) {
  std::ifstream file(test::source_folder() / "docs" / "lua.md");
  const std::string kept{std::istreambuf_iterator<char>(file), {}};
  const test::ProcessResult printed = test::run_process(test::sterna_program(), {"manual"}, test::scratch());
  ASSERT_EQ(printed.status, 0) << printed.errors;
  EXPECT_TRUE(printed.output == kept) << "docs/lua.md is stale: build/release/sterna manual > docs/lua.md";
}

/// Runs examples in a separate folder; file names without a folder are read and written there.
class InFolder {
 public:
  explicit InFolder(const std::filesystem::path& folder) : before_(std::filesystem::current_path()) { std::filesystem::current_path(folder); }
  ~InFolder() { std::filesystem::current_path(before_); }

 private:
  std::filesystem::path before_;
};

TEST(Manual, EveryExampleRuns) {
  const std::filesystem::path folder = test::scratch();
  const InFolder in(folder);
  std::ofstream("sizes.vtu") << k_sizes_vtu;
  for (const char* name : {"wall.stl", "torn.stl", "tail.stl"})
    if (!std::filesystem::exists(name)) std::filesystem::copy(test::source_folder() / "tests" / "data" / "scripts" / "box.stl", name);
  const bool has_cpacs = std::filesystem::exists(test::shared_data() / "cpacs" / "simpletest-flaps.cpacs.xml");
  if (has_cpacs) std::filesystem::copy(test::shared_data() / "cpacs" / "simpletest-flaps.cpacs.xml", "d150.xml");
  ScriptState state({.script = folder / "case.lua", .overrides = {}, .print = [](std::string_view) {}, .on_mesh = {}}, RunContext({.threads = 2}));
  int n_examples = 0;
  for (const ScriptVerb* verb : all_verbs())
    for (const std::string& example : examples_of(*verb)) {
      if (verb->name == "read_cpacs" && !has_cpacs) continue;  // the only input that no verb writes
      if (verb->name == "series") continue;                    // runs processes: checked below
      ++n_examples;
      SCOPED_TRACE(std::string(verb->name) + ": " + example);
      // The setup runs again for each example, because components change in place and files are replaced.
      if (n_examples == 1 || verb->name.find(':') != std::string_view::npos) {
        ASSERT_NO_THROW(state.run(std::string(manual_setup()), "=setup"));
      }
      const std::string expression = "return " + example;
      EXPECT_NO_THROW(state.run(state.is_correct(expression) ? expression : example, "=example"));
    }
  EXPECT_GT(n_examples, 60);
}

TEST(Manual, TheExampleOfSeriesIsCorrect) {
  const std::filesystem::path folder = test::scratch();
  std::ofstream(folder / "case.lua") << manual_setup() << examples_of(*find_verb("series")).front() << "\n";
  ScriptCheck check;
  check_script({.script = folder / "case.lua", .overrides = {}, .print = {}, .on_mesh = {}}, check, RunContext({.threads = 1}));
  for (const ErrorHandle& problem : check.problems) ADD_FAILURE() << problem->what();
}

TEST(Manual, EveryVerbSaysWhatItIs) {
  for (const ScriptVerb* verb : all_verbs()) {
    EXPECT_FALSE(verb->usage.empty()) << verb->name;
    EXPECT_GT(verb->summary.size(), 10u) << verb->name;
    EXPECT_TRUE(!verb->is_heavy || !verb->gives.empty() || verb->name == "model:info") << verb->name << ": check-script has to know what it gives";
    for (const OptionGroup& group : option_groups(*verb))
      for (const OptionDoc& option : group.options) EXPECT_FALSE(option.help.empty()) << verb->name << ", " << option.name;
  }
}

}  // namespace
}  // namespace sterna::scripting
