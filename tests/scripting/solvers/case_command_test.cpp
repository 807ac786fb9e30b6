// `sterna foam-case` and `sterna su2-config`, and kinds of patches that a case sees in place of the mesh's.
#include <gmock/gmock.h>

#include "io/file/surface_file.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/verbs/solver_case.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/error_of.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/process.h"
#include "tests/support/test_shapes.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CaseCommands : public ScriptFixture {
 protected:
  CaseCommands() {
    io::write_surface_file(test::sphere(4), folder_ / "ball.off", RunContext());
    run("volume_mesh{ read_surface 'ball.off', layers = 4, first_height = 0.02, farfield = sphere{ radius = 8 } }:write(" + out("ball.sterna") + ", " +
        out("ball.su2") + ")");
  }
  test::ProcessResult sterna(const std::vector<std::string>& arguments) const { return test::run_process(test::sterna_program(), arguments, folder_); }
};

TEST_F(CaseCommands, WriteWhatTheVerbsWrite) {
  run("read_mesh(" + out("ball.sterna") + "):foam_case{ " + out("by_verb") +
      ", mach = 0.2, altitude = 0, length = 2, alpha = 5*deg, reference_area = math.pi, moment_origin = {0.5, 0, 0}, model = 'laminar', tasks = 2 }");
  const test::ProcessResult made = sterna({"foam-case",
                                           "ball.sterna",
                                           "-o",
                                           "by_command/",
                                           "--mach",
                                           "0.2",
                                           "--altitude",
                                           "0",
                                           "--length",
                                           "2",
                                           "--alpha",
                                           "5deg",
                                           "--reference-area",
                                           "3.141592653589793",
                                           "--moment-origin",
                                           "0.5,0,0",
                                           "--model",
                                           "laminar",
                                           "--tasks",
                                           "2"});
  ASSERT_EQ(made.status, k_exit_success) << made.errors;
  for (const std::string file : {"0/U", "0/p", "system/controlDict", "system/decomposeParDict", "system/fvSchemes", "constant/transportProperties", "Allrun",
                                 "constant/polyMesh/owner", "constant/polyMesh/points", "constant/polyMesh/boundary"})
    EXPECT_EQ(text_of("by_command/" + file), text_of("by_verb/" + file)) << file;

  run("read_mesh(" + out("ball.su2") + "):su2_config{ " + out("by_verb.cfg") +
      ", flow{ mach = 0.5, altitude = 3000, length = 2 }, reference_area = 3, mesh = 'ball.su2', solver = 'RANS' }");
  // The name of the verb does, too; without --mesh it is the mesh that was read.
  const test::ProcessResult config =
      sterna({"su2_config", "ball.su2", "-o", "by_command.cfg", "--flow", "mach=0.5 altitude=3000 length=2", "--reference-area", "3", "--solver", "RANS"});
  ASSERT_EQ(config.status, k_exit_success) << config.errors;
  EXPECT_EQ(text_of("by_command.cfg"), text_of("by_verb.cfg"));
}

TEST_F(CaseCommands, ReportMistakesBeforeReadingTheMesh) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"foam-case", "none.sterna", "-o", "case", "--mach", "0.5", "--reynolds", "1e6", "--length", "1"}, "state of the gas"},
      {{"foam-case", "none.sterna", "-o", "case", "--model", "kEpsilon", "--reynolds", "1e6", "--length", "1"}, "kOmegaSST"},
      {{"foam-case", "none.sterna", "-o", "case", "--reynolds", "1e6"}, "length"},
      {{"foam-case", "none.sterna", "-o", "case", "--reynolds", "1e6", "--length", "1", "--taks", "2"}, "did you mean --tasks?"},
      {{"foam-case", "none.sterna", "-o", "case", "--reynolds", "1e6", "--length", "1", "--kind", "ball=slippery"}, "not a patch kind"},
      {{"foam-case", "none.sterna", "-o", "case", "--reynolds", "1e6", "--length", "1", "--boundary", "prop:trust=3"}, "thrust"},
      {{"foam-case", "none.sterna", "-o", "case", "--reynolds", "1e6", "--flow", "reynolds=2e6 length=1"}, "given twice"},
      {{"su2-config", "none.su2", "-o", "a.cfg", "--reynolds", "1e6", "--length", "1"}, "Mach number is unknown"},
      {{"su2-config", "none.su2", "-o", "a.cfg", "--mach", "0.5", "--altitude", "0", "--length", "1", "--reference-area", "1", "--mesh", "a.vtu"}, "SU2 reads"},
      {{"foam-caes", "none.sterna"}, "did you mean foam-case?"}};
  for (const auto& [arguments, reported] : cases) {
    const test::ProcessResult result = sterna(arguments);
    EXPECT_EQ(result.status, k_exit_usage) << result.errors;
    EXPECT_THAT(result.errors, AllOf(HasSubstr(reported), Not(HasSubstr("none.sterna:")))) << arguments.back();
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "case"));
}

TEST_F(CaseCommands, KindsOfPatchesAreThoseOfTheCase) {
  run("local m = read_mesh(" + out("ball.sterna") + ")\nm:foam_case{ " + out("slips") +
      ", reynolds = 100, length = 1, model = 'laminar', monitor = 'wall', kinds = { ['w*'] = 'symmetry', wall = 'slip', farfield = 'inflow' } }\nprint(m)");
  EXPECT_THAT(text_of("slips/0/U"), AllOf(HasSubstr("type slip"), Not(HasSubstr("noSlip")), Not(HasSubstr("freestream")), HasSubstr("type fixedValue")));
  EXPECT_THAT(text_of("slips/constant/polyMesh/boundary"), Not(HasSubstr("type wall")));
  const std::string reported =
      error("read_mesh(" + out("ball.sterna") + "):foam_case{ " + out("no") + ", reynolds = 100, length = 1, kinds = { top = 'slip' } }");
  EXPECT_THAT(reported, AllOf(HasSubstr("case.lua:1: mesh:foam_case"), HasSubstr("kinds[\"top\"]"), HasSubstr("names are farfield, wall")));
  EXPECT_THAT(error("read_mesh(" + out("ball.sterna") + "):su2_config{ " + out("no.cfg") +
                    ", mach = 0.5, altitude = 0, length = 1, reference_area = 1, kinds = { 'slip', wall = 3 } }"),
              HasSubstr("kinds: expected a table with names of patches as keys"));
  EXPECT_THAT(error("read_mesh(" + out("ball.sterna") + "):su2_config{ " + out("no.cfg") +
                    ", mach = 0.5, altitude = 0, length = 1, reference_area = 1, kinds = { wall = 'slippery' } }"),
              HasSubstr("\"slippery\" is not a patch kind"));
  const test::ProcessResult config = sterna({"su2-config", "ball.su2", "-o", "slip.cfg", "--flow", "mach=0.5 altitude=3000 length=2", "--reference-area", "3",
                                             "--monitor", "wall", "--kind", "wall=slip"});
  ASSERT_EQ(config.status, k_exit_success) << config.errors;
  EXPECT_THAT(text_of("slip.cfg"), AllOf(HasSubstr("MARKER_EULER= ( wall )"), Not(HasSubstr("MARKER_HEATFLUX"))));
}

TEST_F(CaseCommands, MonitorIsTextWithMatchingPatterns) {
  const std::string mesh = "read_mesh(" + out("ball.sterna") + ")";
  const std::string flow = ", reynolds = 100, length = 1, ";
  EXPECT_THAT(error(mesh + ":foam_case{ " + out("no") + flow + "monitor = {'wing*', 'body'} }"),
              AllOf(HasSubstr("monitor: a table is not allowed here, expected a string"), HasSubstr("write monitor = \"wing* body\"")));
  EXPECT_THAT(error(mesh + ":foam_case{ " + out("no") + flow + "monitor = 'wall wal' }"),
              AllOf(HasSubstr("monitor: no patch has a name like \"wal\""), HasSubstr("did you mean \"wall\"?")));
}

TEST(CaseKinds, SidesThatBelongTogetherKeepTheirs) {
  const HybridMesh mesh =
      test::box_of_patches({{"prop", PatchKind::interface}, {"prop.back", PatchKind::interface}, {"body", PatchKind::wall}, {"far", PatchKind::farfield}});
  EXPECT_FALSE(with_kinds(mesh, {}, "a case"));
  EXPECT_EQ(with_kinds(mesh, {{"b*", PatchKind::slip}}, "a case")->patches[PatchId(2)].kind, PatchKind::slip);
  test::expect_error(ErrorCode::bad_argument, "\"prop\" is a side of an actuator disc", [&] {
    (void)with_kinds(mesh, {{"prop*", PatchKind::slip}}, "a case");
  });
  test::expect_error(ErrorCode::bad_argument, "only volume_mesh makes such patches", [&] {
    (void)with_kinds(mesh, {{"far", PatchKind::interface}}, "a case");
  });
}

}  // namespace
}  // namespace sterna::scripting
