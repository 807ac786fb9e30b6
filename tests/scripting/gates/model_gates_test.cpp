// Gates G17 and G18 as users get them: mesh:check{ wall = wall }, wall:check(), sterna check --model.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/file/volume_file.h"
#include "scripting/terminal/exit_status.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ModelGates : public ScriptFixture {
 protected:
  test::ProcessResult sterna(const std::vector<std::string>& arguments) { return test::run_process(test::sterna_program(), arguments, folder_); }
  /// The entry of a measure in the report of `sterna check --json`.
  static nlohmann::json measure(const test::ProcessResult& result, const std::string& name) {
    const nlohmann::json report = nlohmann::json::parse(result.output);
    for (const nlohmann::json& entry : report["measures"])
      if (entry["measure"] == name) return entry;
    return {};
  }
};

const std::string k_can = "local can = cylinder{ {0,0,0}, {2,0,0}, radius=1, name='can' } local wall = surface_mesh{ can, max_edge=0.5 } ";
const std::string k_mesh = "local mesh = volume_mesh{ wall, layers=3, first_height=1e-2, farfield=sphere{ radius=10 } } ";

TEST_F(ModelGates, MeshIsComparedWithModelOfItsWall) {
  const std::string printed = run(k_can + k_mesh + "mesh:check{ wall = wall } mesh:write(" + out("can.su2") + ") mesh:write(" + out("can.sterna") +
                                  ") can:write(" + out("can.step") + ") wall:check()");
  EXPECT_THAT(printed, AllOf(HasSubstr("  G17  wall nodes off the CAD, / length pass "), HasSubstr("  G18  wall facets against the CAD      pass ")));
  EXPECT_THAT(text_of("can.su2.json"),
              AllOf(HasSubstr("\"cad_distance\": {\n        \"gate\": \"G17\",\n        \"state\": \"pass\""), HasSubstr("\"cad_normal\"")));
  // The mesh alone says how.
  EXPECT_THAT(
      run(k_can + k_mesh + "mesh:check{ details = true }"),
      AllOf(HasSubstr("G17  wall nodes off the CAD, / length not checked: needs the model: mesh:check{ wall = wall }"), HasSubstr("--model model.step")));

  const test::ProcessResult clean = sterna({"check", "can.su2", "--model", "can.step", "--json"});
  ASSERT_EQ(clean.status, k_exit_success) << clean.errors;
  EXPECT_EQ(measure(clean, "cad_distance")["state"], "pass");
  EXPECT_LT(measure(clean, "cad_distance")["worst"], 1e-9);
  EXPECT_EQ(measure(clean, "cad_normal")["state"], "pass");
  EXPECT_GT(measure(clean, "cad_normal")["total"], 100);

  // One wall node moved out by a known distance, in the file.
  HybridMesh mesh = io::read_volume_file(folder_ / "can.sterna", {});
  NodeId moved;
  for (const BoundaryTriangle& face : mesh.boundary_triangles)
    for (const NodeId n : face.nodes)
      if (const Point& p = mesh.points[n];
          !moved.is_valid() && mesh.patches[face.patch].name == "can" && std::abs(std::hypot(p.y, p.z) - 1.0) < 1e-9 && p.x > 0.3 && p.x < 1.7)
        moved = n;
  ASSERT_TRUE(moved.is_valid());
  const Point before = mesh.points[moved];
  mesh.points[moved] = {before.x, before.y * 1.001, before.z * 1.001};
  io::write_volume_file(mesh, folder_ / "moved.su2", {});
  const nlohmann::json off = measure(sterna({"check", "moved.su2", "--model", "can.step", "--json"}), "cad_distance");
  EXPECT_EQ(off["state"], "fail");
  EXPECT_EQ(off["beyond_hard"], 1);
  EXPECT_NEAR(off["worst"].get<double>(), 1e-3 / 2.0, 1e-9);  // the can is 2 m long
  EXPECT_NEAR(off["places"][0]["position"][0].get<double>(), before.x, 1e-12);
  EXPECT_THAT(off["places"][0]["what"].get<std::string>(), AllOf(HasSubstr("patch can"), HasSubstr("0.001 m off face \"can\"")));
}

TEST_F(ModelGates, WallsKnowTheirModelWhereTheyAreMoved) {
  const std::string printed = run(k_can + "wall:rotate{ axis = {0, 1, 0}, angle = 10*deg }:move{ 3, 0, 1 }:check{ strict = true }");
  EXPECT_THAT(printed, AllOf(HasSubstr("G17"), HasSubstr("pass"), HasSubstr("triangles against the model")));
}

TEST_F(ModelGates, MistakesSayWhatToDo) {
  const std::string box = (test::corpus() / "scripts" / "box.stl").string();
  EXPECT_THAT(error("read_surface{ '" + box + "' }:check()"),
              AllOf(HasSubstr("has no model to be compared with"), HasSubstr("surface_mesh{ read_cad \"model.step\" }")));
  EXPECT_THAT(error(k_can + k_mesh + "mesh:check{ wall = can }"), HasSubstr("wall: expected the surface of surface_mesh, not a model"));
  EXPECT_THAT(error(k_can + k_mesh + "mesh:check{ wall = half(wall) }"), HasSubstr("before half{ }"));
  EXPECT_THAT(error(k_can + k_mesh + "mesh:check{ wall = wall, quality = false }"), HasSubstr("belong to quality"));
  std::filesystem::copy(box, folder_ / "box.stl");
  EXPECT_THAT(sterna({"check", "can.su2", "--model", "box.stl"}).errors, HasSubstr("--model box.stl: the file is not a model"));
}

TEST_F(ModelGates, OfARealWing) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string wing = "'" + (test::shared_data() / "cad" / "tigl_simplewing_simplewing.brep").string() + "'";
  const std::string printed =
      run("local wall = surface_mesh{ read_cad(" + wing +
              ") } local mesh = volume_mesh{ wall, layers=5, first_height=1e-3*wall.length, farfield=sphere{ radius=20 } } mesh:check{ wall = wall }",
          {}, 2);
  EXPECT_THAT(printed, HasSubstr("  G17  wall nodes off the CAD, / length pass "));
  const std::size_t at = printed.find("  G17");
  std::printf("%s", printed.substr(at, printed.find("\n  G", printed.find("  G18", at)) - at).c_str());
}

}  // namespace
}  // namespace sterna::scripting
