// A surface mesh carried to a deformed model: the same triangles on the new surface, measured and proved like a mesh made there. The transfer is refused where
// the mesh would not be good.
#include "surfmesh/model/carry_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/model/airfoil.h"
#include "geom/model/components.h"
#include "geom/model/deform.h"
#include "geom/model/shapes.h"
#include "tests/support/test_constants.h"

namespace sterna::surfmesh {
namespace {

using testing::HasSubstr;

using test::k_context;

/// Returns a swept and tapered wing with round tips and a blunt trailing edge; its outer section is rotated nose-up.
Model twisted_wing(double twist) {
  Wing wing{.name = "W", .is_symmetric = true, .trailing_edge = 0.01};
  for (const double y : {4.0, 1.5, 0.0}) {
    WingSection s{.name = "y", .leading_edge = {0.5 * y, y, 0.0}, .chord = 2.0 - 0.3 * y, .twist = twist * y / 4.0};
    s.points = naca_airfoil("2412").points;
    wing.sections.push_back(s);
  }
  wing.right_tip = wing.left_tip = {CapShape::strip, 1.0};
  return make_wing(wing);
}

/// Returns a body with poles at nose and tail.
Model body() {
  Body body{.name = "B"};
  for (const double x : {-2.0, -0.6, 0.8, 3.6, 5.0}) body.frames.push_back({.name = "x", .center = {x, 0.0, 0.0}, .height = 1.0, .width = 1.0});
  body.nose = body.tail = {CapShape::dome, 1.5};
  return make_body(body, ComponentKind::body);
}

Model bent(const Model& model, double by) {
  return deformed(model, std::make_shared<FunctionMap>([by](const Point& p) { return Point{p.x, p.y, p.z + by * (p.x * p.x + p.y * p.y)}; }, 1e-3), k_context);
}

StructuredMesh mesh_of(const Model& model, double max_edge = 0.2) {
  SurfaceMeshOptions options;
  options.sizes.max_edge = max_edge;
  options.sizes.leading_edge_chordwise = 0.02;  // bands: stretched triangles are carried too
  options.sizes.leading_edge_stretch = 5.0;
  return {structure_of(model), mesh_model(model, options, {}, k_context)};
}

CarriedMesh carried(const StructuredMesh& from, const Model& to) {
  const ModelStructure structure = structure_of(to);
  EXPECT_EQ(difference_of(from.structure, structure), "");
  return carry_mesh(from, to, structure, carried_points(from, to, structure, k_context), {}, k_context);
}

TEST(CarryMesh, OnItsOwnModelItIsTheMesh) {
  for (const Model& model : {twisted_wing(0.0), body(), make_cylinder("can", {0, 0, 0}, {2, 0, 0}, 1.0), make_box("box", {0, 0, 0}, {1, 1, 1})}) {
    const StructuredMesh from = mesh_of(model);
    const CarriedMesh again = carried(from, model);
    ASSERT_TRUE(again.mesh) << again.objection;
    for (const VertexId v : from.mesh.mesh.points.ids()) EXPECT_LT(distance(again.mesh->mesh.points[v], from.mesh.mesh.points[v]), 1e-13);
    const SurfaceMeshReport &was = from.mesh.report, &now = again.mesh->report;
    EXPECT_NEAR(now.min_angle, was.min_angle, 1e-9);
    EXPECT_NEAR(now.max_angle, was.max_angle, 1e-9);
    EXPECT_NEAR(now.max_smooth_angle, was.max_smooth_angle, 1e-9);  // seams and creases are classified again
    EXPECT_NEAR(now.share_normals, was.share_normals, 1e-12);
    EXPECT_EQ(now.least_angles, was.least_angles);
    EXPECT_EQ(now.loose_edges.size(), was.loose_edges.size());
    EXPECT_EQ(now.bands.n_triangles, was.bands.n_triangles);
  }
}

TEST(CarryMesh, FollowsBendWithSameTrianglesOnNewSurface) {
  for (const Model& model : {twisted_wing(0.0), body()}) {
    const StructuredMesh from = mesh_of(model);
    const Model to = bent(model, 0.03);
    const CarriedMesh result = carried(from, to);
    ASSERT_TRUE(result.mesh) << result.objection << format_point(result.location);
    EXPECT_EQ(result.mesh->mesh.triangles.raw(), from.mesh.mesh.triangles.raw());
    for (const VertexId v : from.mesh.mesh.points.ids()) {
      const Point p = from.mesh.mesh.points[v];
      EXPECT_LT(distance(result.mesh->mesh.points[v], {p.x, p.y, p.z + 0.03 * (p.x * p.x + p.y * p.y)}), 1e-12);
    }
    EXPECT_EQ(result.mesh->report.n_crossings, 0);
    EXPECT_GT(result.mesh->report.min_angle, 0.7 * from.mesh.report.min_angle);
  }
}

TEST(CarryMesh, FollowsATwistedWing) {
  const StructuredMesh from = mesh_of(twisted_wing(0.0));
  const CarriedMesh result = carried(from, twisted_wing(0.07));
  ASSERT_TRUE(result.mesh) << result.objection << format_point(result.location);
  EXPECT_EQ(result.mesh->mesh.triangles.raw(), from.mesh.mesh.triangles.raw());
  double most = 0.0;
  for (const VertexId v : from.mesh.mesh.points.ids()) most = std::max(most, distance(result.mesh->mesh.points[v], from.mesh.mesh.points[v]));
  EXPECT_GT(most, 0.03);
}

TEST(CarryMesh, IsRefusedWithLocationOfBadTriangles) {
  const StructuredMesh from = mesh_of(twisted_wing(0.0));
  const CarriedMesh result = carried(from, bent(twisted_wing(0.0), 1.0));
  EXPECT_FALSE(result.mesh);
  EXPECT_THAT(result.objection, HasSubstr("would "));
  EXPECT_GT(std::abs(result.location.y), 1.0);  // at the tips, where the bending is largest
  const CarriedMesh long_wing = carried(from, deformed(twisted_wing(0.0),
                                                       std::make_shared<FunctionMap>(
                                                           [](const Point& p) {
                                                             return Point{1.6 * p.x, 1.6 * p.y, 1.6 * p.z};
                                                           },
                                                           1e-3),
                                                       k_context));
  EXPECT_THAT(long_wing.objection, HasSubstr("too long or too short, the worst 1.6 times"));
}

TEST(ModelStructure, TellsWhatDiffers) {
  const ModelStructure one = structure_of(twisted_wing(0.0));
  EXPECT_EQ(difference_of(one, structure_of(bent(twisted_wing(0.0), 0.1))), "");
  EXPECT_THAT(difference_of(one, structure_of(body())), HasSubstr("the reference"));
  Model renamed = twisted_wing(0.0);
  renamed.faces.raw().front().name = "other";
  EXPECT_THAT(difference_of(one, structure_of(renamed)), HasSubstr("has the name \"W\" in the reference"));
}

}  // namespace
}  // namespace sterna::surfmesh
