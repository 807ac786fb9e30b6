// Faces whose triangles repair replaced: retained triangles are counted, the other faces are reported with their distance.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geom/math/measures.h"
#include "geom/model/shapes.h"
#include "surfmesh/model/replaced_faces.h"
#include "surfmesh/repair/repair_surface.h"
#include "tests/support/test_constants.h"

namespace sterna::surfmesh {
namespace {

using test::k_context;

constexpr double k_radius = 0.5;

/// Returns the surface without the triangles about the vertex nearest to a point.
SurfaceSoup with_hole(const TriMesh& mesh, const Point& at) {
  VertexId nearest(std::uint64_t{0});
  for (const VertexId v : mesh.points.ids())
    if (distance(mesh.points[v], at) < distance(mesh.points[nearest], at)) nearest = v;
  SurfaceSoup soup{.source = "holed"};
  soup.points.assign(mesh.points.begin(), mesh.points.end());
  for (const Patch& patch : mesh.patches) soup.patch_names.push_back(patch.name);
  for (const TriangleId t : mesh.triangles.ids()) {
    const TriangleVertices& v = mesh.triangles[t];
    if (v[0] == nearest || v[1] == nearest || v[2] == nearest) continue;
    soup.triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
    soup.patch.push_back(mesh.triangle_patch[t].value());
  }
  return soup;
}

TEST(ReplacedFaces, KeptFacesAreExactOthersNamedWithDistance) {
  const Model model = make_cylinder("tube", {0, 0, 0}, {2, 0, 0}, k_radius);
  SurfaceMeshOptions options;
  options.sizes.max_edge = 0.15;
  const SurfaceMesh made = mesh_model(model, options, {}, k_context);
  const ModelWall before(model, made);
  const Point hole{1.0, 0.0, k_radius};
  const SurfaceSoup soup = with_hole(made.mesh, hole);
  const TriMesh repaired = repair_surface({soup}, {}, {}, k_context).mesh;
  const ReplacedFaces behind = find_replaced_faces(before, made.mesh, repaired, k_context);

  EXPECT_EQ(behind.n_exact, static_cast<std::int64_t>(soup.triangles.size()));
  ASSERT_EQ(behind.faces.size(), 1u);
  const ReplacedFace& face = behind.faces.front();
  EXPECT_EQ(face.name, "tube");
  EXPECT_EQ(face.n_gone, static_cast<std::int64_t>(made.mesh.n_triangles() - soup.triangles.size()));
  EXPECT_EQ(face.n_new, static_cast<std::int64_t>(repaired.n_triangles() - soup.triangles.size()));
  EXPECT_GT(face.distance, 1e-6);
  EXPECT_LT(face.distance, 0.05) << "a hole of two edges";
  EXPECT_LT(distance(face.location, hole), 0.3);
  EXPECT_THAT(to_lines(behind.faces, 5).front(), testing::AllOf(testing::HasSubstr("\"tube\""), testing::HasSubstr("m from the model")));
}

TEST(ReplacedFaces, UnchangedTrianglesGiveNoReport) {
  const Model model = make_box("crate", {0, 0, 0}, {1, 1, 1});
  const SurfaceMesh made = mesh_model(model, {}, {}, k_context);
  const ModelWall before(model, made);
  const ReplacedFaces behind = find_replaced_faces(before, made.mesh, made.mesh, k_context);
  EXPECT_EQ(behind.n_exact, static_cast<std::int64_t>(made.mesh.n_triangles()));
  EXPECT_TRUE(behind.faces.empty());
}

}  // namespace
}  // namespace sterna::surfmesh
