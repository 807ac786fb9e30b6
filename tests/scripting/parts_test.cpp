// Parts of models and surfaces, made in their own frames and moved: independent of the kind of move and of the surroundings.
#include <gmock/gmock.h>

#include "geom/model/shapes.h"
#include "scripting/values/fluid_model.h"
#include "scripting/values/model_surface.h"
#include "scripting/verbs/surface_motion.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/test_constants.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;
using testing::Not;

class PartScripts : public ScriptFixture {};

using test::k_context;
const Transform k_turn = rotation({0.3, 0, 0}, {0, 1, 0}, -0.07);

ModelValue rod() {
  ModelValue value;
  value.model = make_cylinder("rod", {-0.5, 0, 0}, {0.5, 0, 0}, 0.2);
  return value;
}
ModelValue tunnel() {
  ModelValue value;
  value.model = make_test_section({.length = 4.0, .width = 2.0, .height = 2.0});
  return value;
}
SurfaceRecipe coarse() {
  SurfaceRecipe recipe;
  recipe.options.sizes.max_edge = 0.2;
  recipe.options.sizes.curvature_angle = 0.4;
  return recipe;
}
SurfaceValue meshed(const std::vector<ModelValue>& models) {
  std::vector<ModelHandle> handles;
  for (const ModelValue& model : models) handles.push_back(std::make_shared<const ModelValue>(model));
  return mesh_models(handles, coarse(), {}, k_context);
}
ModelValue moved(ModelValue value, const Transform& motion) {
  move_parts(motion, value);
  return value;
}

TEST(Parts, MovedModelHasTrianglesOfItsFrame) {
  const SurfaceValue still = meshed({rod()}), turned = meshed({moved(moved(rod(), k_turn), translation({0, 0, 0.25}))});
  EXPECT_TRUE(still.parts.empty());
  ASSERT_EQ(turned.parts.size(), 1u);
  EXPECT_EQ(turned.mesh.triangles.raw(), still.mesh.triangles.raw());
  EXPECT_EQ(turned.parts.front().own->points.raw(), still.mesh.points.raw());
  const Transform both = translation({0, 0, 0.25}) * k_turn;
  for (const VertexId v : still.mesh.points.ids()) ASSERT_EQ(turned.mesh.points[v], both.point(still.mesh.points[v]));
  // The underlying model is at the position of the mesh.
  const auto p = corners(turned.mesh, TriangleId(0));
  EXPECT_LT(distance(turned.true_surface.wall->nearest(p[0], TriangleId(0), {1.0, 0.0, 0.0}), p[0]), 1e-12);
}

TEST(Parts, AMotionThatMovesNothingChangesNothing) {
  const SurfaceValue still = meshed({rod()}), turned = meshed({moved(rod(), rotation({1, 2, 3}, {0, 1, 0}, 0.0))});
  ASSERT_EQ(turned.parts.size(), 1u);
  EXPECT_EQ(turned.mesh.points.raw(), still.mesh.points.raw());
  EXPECT_EQ(turned.mesh.triangles.raw(), still.mesh.triangles.raw());
}

TEST(Parts, TunnelDoesNotChangeModelInside) {
  const SurfaceValue still = meshed({rod()}), first = meshed({moved(rod(), k_turn), tunnel()}),
                     second = meshed({moved(rod(), translation({0.2, 0.1, 0.3}) * k_turn), tunnel()});
  ASSERT_EQ(first.parts.size(), 2u);
  ASSERT_EQ(second.parts.size(), 2u);
  EXPECT_TRUE(first.report.is_closed);
  EXPECT_EQ(first.report.n_components, 2);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(first.parts[i].own->points.raw(), second.parts[i].own->points.raw());
  EXPECT_EQ(first.parts.back().own->points.raw(), still.mesh.points.raw());  // the tunnel comes first
  EXPECT_EQ(second.mesh.n_triangles(), first.mesh.n_triangles());
}

TEST(Parts, SeveralModelsKeepTheirPlacesInAnAssembly) {
  const ModelHandle a = std::make_shared<const ModelValue>(moved(rod(), k_turn)),
                    b = std::make_shared<const ModelValue>(moved(rod(), translation({0, 0, 0.6})));
  const ModelValue apart = assemble_united({a, b}, k_context);
  ASSERT_EQ(apart.parts.size(), 2u);
  EXPECT_EQ(apart.parts[0].placement, k_turn);
  EXPECT_EQ(own_model(apart, apart.parts, 1).components.raw().front().name, "rod2");
  // With a third part that touches the second, the first remains unchanged; the other two become one part made at its final position.
  const ModelHandle c = std::make_shared<const ModelValue>(moved(rod(), translation({0.5, 0, 0.7})));
  const ModelValue united = assemble_united({a, b, c}, k_context);
  ASSERT_EQ(united.parts.size(), 2u);
  EXPECT_EQ(united.parts[0].placement, k_turn);
  EXPECT_TRUE(united.parts[1].is_in_place());
  EXPECT_EQ(united.model.solids.size(), 2u);
  const SurfaceValue surface = meshed({united});
  EXPECT_EQ(surface.parts.size(), 2u);
  EXPECT_TRUE(surface.report.is_closed);
}

TEST(Parts, PartsThroughTunnelWallAreMeshedInPlace) {
  ModelValue with_way_out = tunnel();
  with_way_out.through = {"rod*"};
  const SurfaceValue cut = meshed({moved(rod(), translation({2.0, 0, 0}) * k_turn), with_way_out});
  EXPECT_TRUE(cut.parts.empty());
  EXPECT_TRUE(cut.report.is_closed);
}

TEST(Parts, SurfacesMoveAsModelsDo) {
  const SurfaceValue still = meshed({rod()}), once = moved_surface(still, translation({0, 0, 0.25}) * k_turn),
                     twice = moved_surface(moved_surface(still, k_turn), translation({0, 0, 0.25}));
  EXPECT_EQ(once.mesh.points.raw(), twice.mesh.points.raw());
  ASSERT_EQ(twice.parts.size(), 1u);
  EXPECT_EQ(twice.parts.front().own->points.raw(), still.mesh.points.raw());
}

TEST_F(PartScripts, TriangulatedModelInTunnelAtAnyAttitude) {
  run("surface_mesh{ cylinder{ {-0.5, 0, 0}, {0.5, 0, 0}, radius = 0.2, name = 'rod' }, max_edge = 0.2, curvature_angle = 0.4 }:write(" + out("rod.stl") + ")");
  const std::string text = run("local rod = read_surface(" + out("rod.stl") +
                               ") local tunnel = surface_mesh{ test_section{ length = 4, width = 2, height = 2, walls = 'slip' } } "
                               "for _, a in ipairs{ 0, 8 } do local wall = assembly{ rod:rotate{ pitch = a*deg }, tunnel } local m = volume_mesh{ wall, layers "
                               "= 8, first_height = 1e-4 } "
                               "print(wall.is_closed, m.coverage > 0.99) end");
  EXPECT_EQ(text, "true\ttrue\ntrue\ttrue\n");
  EXPECT_THAT(error("local a = surface_mesh{ box{ {0,0,0}, {1,1,1} } } assembly{ a, a:move{ 0.1, 0.1, 0.1 } }"), HasSubstr("pairs of triangles cross"));
  EXPECT_THAT(error("surface_mesh{ box{ {0,0,0}, {1,1,1} } }:rotate{ pitch = 0.1, angle = 1 }"), HasSubstr("not both"));
}

TEST_F(PartScripts, GapsBetweenPartsRequireSizesInPlace) {
  run("local a = box{ {0,0,0}, {1,1,1} }:move{ 0.1, 0, 0 } local b = box{ {0,0,1.05}, {1,1,2} } surface_mesh{ a, b, max_edge = 0.3, gap_cells = 1 }");
  EXPECT_THAT(log_, HasSubstr("gaps between parts set edge lengths"));
  run("local a = box{ {0,0,0}, {1,1,1} }:move{ 0.1, 0, 0 } local b = box{ {0,0,1.05}, {1,1,2} } surface_mesh{ a, b, max_edge = 0.3 }");
  EXPECT_THAT(log_, Not(HasSubstr("gaps between parts")));
}

TEST_F(PartScripts, SourcesCountWhereThePartIs) {
  // The same source at the same end of the box: once at the original position, once 10 m away.
  const std::string fine = "print(surface_mesh{ box{ {0,0,0}, {1,1,1} }%s, max_edge = 0.3, sources = { point{ {%s,0,0}, size = 0.05 } } }.triangles)";
  const auto with = [&](const std::string& move, const std::string& x) {
    std::string text = fine;
    text.replace(text.find("%s"), 2, move);
    text.replace(text.find("%s"), 2, x);
    return run(text);
  };
  const double here = std::stod(with("", "0")), there = std::stod(with(":move{ 8, 0, 0 }", "8")), far = std::stod(with(":move{ 8, 0, 0 }", "0"));
  EXPECT_NEAR(here, there, 0.02 * here) << "places differ by rounding, and so a few triangles";
  EXPECT_LT(far, 0.5 * here);
}

}  // namespace
}  // namespace sterna::scripting
