// Remeshing as users call it: remesh{}, read_surface{ remesh }, `sterna remesh`, `sterna mesh --remesh`, and from the cache.
#include <gmock/gmock.h>

#include "scripting/terminal/exit_status.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class RemeshVerb : public ScriptFixture {
 protected:
  test::ProcessResult sterna(const std::vector<std::string>& arguments) { return test::run_process(test::sterna_program(), arguments, folder_); }
  void write_box() { run("surface_mesh{ box{ {0,0,0}, {1,1,1} }, max_edge = 1 }:write(" + out("box.stl") + ")"); }
};

TEST_F(RemeshVerb, VerbAndOptionOfReadSurfaceAgree) {
  write_box();
  EXPECT_EQ(run("local w = read_surface(" + out("box.stl") + ") local r = remesh{ w, max_edge = 0.2 } local s = read_surface{ " + out("box.stl") +
                ", remesh = { max_edge = 0.2 } } print(r.triangles > 5*w.triangles, r.triangles == s.triangles, r.is_closed, r.length == 1) "
                "print(remesh(w).triangles == read_surface{ " +
                out("box.stl") + ", remesh = true }.triangles)"),
            "true\ttrue\ttrue\ttrue\ntrue\n");
  EXPECT_THAT(log_, AllOf(HasSubstr("remeshed: "), HasSubstr("distance of the new surface from the input surface")));
  EXPECT_EQ(
      run("local w = read_surface(" + out("box.stl") +
          ") local n = remesh{ w, max_edge = 0.2 }.triangles print(remesh{ w, max_edge = 0.2, sources = { point{ {0,0,0}, size = 0.02 } } }.triangles > n, "
          "remesh{ w, max_edge = 0.2, size = function(x, y, z) return 0.1 end }.triangles > 2*n)"),
      "true\ttrue\n");
}

TEST_F(RemeshVerb, MistakesAreTold) {
  write_box();
  const std::string wall = "local w = read_surface(" + out("box.stl") + ") ";
  EXPECT_THAT(error(wall + "remesh{ w, max_edgy = 1 }"), HasSubstr("max_edge"));
  EXPECT_THAT(error("remesh{ box{ {0,0,0}, {1,1,1} } }"), HasSubstr("surface_mesh{ model }"));
  EXPECT_THAT(error("read_surface{ " + out("box.stl") + ", remesh = 3 }"), HasSubstr("true or a table"));
  EXPECT_THAT(error(wall + "remesh{ w, patches = { fuselage = { max_edge = 0.1 } } }"), HasSubstr("fuselage"));
}

TEST_F(RemeshVerb, CommandLineAndCache) {
  write_box();
  EXPECT_EQ(sterna({"remesh", "box.stl", "-o", "fine.stl", "--max-edge", "0.2", "--cache", "kept"}).status, k_exit_success);
  const test::ProcessResult again = sterna({"remesh", "box.stl", "-o", "again.stl", "--max-edge", "0.2", "--cache", "kept"});
  EXPECT_EQ(again.status, k_exit_success);
  EXPECT_EQ(text_of("fine.stl"), text_of("again.stl"));
  const test::ProcessResult mesh =
      sterna({"mesh", "box.stl", "--remesh", "--set", "remesh.max_edge=0.25", "--layers", "3", "--first-height", "1e-3", "-o", "box.su2"});
  EXPECT_EQ(mesh.status, k_exit_success);
  EXPECT_NE(sterna({"mesh", "box.stl", "--set", "remesh.max_edge=0.25", "--layers", "3", "--first-height", "1e-3", "-o", "box.su2"}).status, k_exit_success);
}

}  // namespace
}  // namespace sterna::scripting
