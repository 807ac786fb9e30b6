// Crevices filled as users do it: fill_crevices{} and `sterna mesh --fill-crevices`.
#include <gmock/gmock.h>

#include "scripting/terminal/exit_status.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CrevicesVerb : public ScriptFixture {
 protected:
  test::ProcessResult sterna(const std::vector<std::string>& arguments) { return test::run_process(test::sterna_program(), arguments, folder_); }
  /// Two boxes with a gap of 20 mm.
  std::string boxes() const {
    return "local w = surface_mesh{ aircraft{ box{ {0,0,0}, {1,1,1}, name = 'a' }, box{ {1.02,0,0}, {2,1,1}, name = 'b' } }, max_edge = 0.3 } ";
  }
};

TEST_F(CrevicesVerb, GapIsFilledAndReported) {
  EXPECT_EQ(run(boxes() + "local f = fill_crevices{ w, width = 30*mm } print(f.is_closed, f.triangles ~= w.triangles)"), "true\ttrue\n");
  EXPECT_THAT(log_, AllOf(HasSubstr("crevices filled: 1 up to 0.03 m wide, 0.02 m^3 in total"), HasSubstr("crevice filled at "), HasSubstr("between a, b"),
                          HasSubstr("parts 2 -> 1")));
}

TEST_F(CrevicesVerb, NarrowWidthChangesNothingAndWarns) {
  EXPECT_EQ(run(boxes() + "print(fill_crevices{ w, width = 10*mm }.triangles == w.triangles)"), "true\n");
  EXPECT_THAT(log_, HasSubstr("no crevice up to 0.01 m wide was found; the surface is unchanged"));
}

TEST_F(CrevicesVerb, MistakesAreReported) {
  EXPECT_THAT(error(boxes() + "fill_crevices{ w }"), HasSubstr("width"));
  EXPECT_THAT(error(boxes() + "fill_crevices{ w, width = -1 }"), HasSubstr("width"));
  EXPECT_THAT(error(boxes() + "fill_crevices{ w, widht = 1 }"), HasSubstr("did you mean \"width\"?"));
  EXPECT_THAT(error("fill_crevices{ box{ {0,0,0}, {1,1,1} }, width = 0.1 }"), HasSubstr("expected one surface"));
}

TEST_F(CrevicesVerb, CommandLineFillsBeforeMeshing) {
  run(boxes() + "w:write(" + out("boxes.stl") + ")");
  const std::vector<std::string> mesh = {"mesh", "boxes.stl", "--layers", "3", "--first-height", "1e-3", "-o", "m.su2"};
  std::vector<std::string> filled = mesh;
  filled.insert(filled.end(), {"--fill-crevices", "30mm"});
  const test::ProcessResult made = sterna(filled);
  EXPECT_EQ(made.status, k_exit_success) << made.errors;
  EXPECT_THAT(made.output + made.errors, HasSubstr("crevices filled: 1"));
  std::vector<std::string> without = mesh;
  without.insert(without.end(), {"--set", "fill_crevices.angle=45*deg"});
  EXPECT_NE(sterna(without).status, k_exit_success);
}

}  // namespace
}  // namespace sterna::scripting
