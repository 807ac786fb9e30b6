// A real surface mesh follows its model through a deflection known at scattered points: file, map, deformed model, vertices evaluated again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "geom/base/error.h"
#include "geom/model/deform.h"
#include "geom/model/model_measures.h"
#include "geom/model/radial_map.h"
#include "io/file/cad_file.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/data.h"
#include "tests/support/test_shapes.h"

namespace sterna::surfmesh {
namespace {

/// Writes the output of a structural solver for a wing of 2 m half span: deflections along two spars.
std::filesystem::path displacements(double tip) {
  const std::filesystem::path path = test::scratch() / "deflection.txt";
  std::ofstream file(path);
  file << "# x y z dx dy dz\n";
  for (int i = 0; i <= 10; ++i)
    for (const double x : {0.2, 0.7}) {
      const double y = 0.2 * i, s = y / 2.0, twist = -0.08 * s * (x - 0.4);
      file << x << ", " << y << ", 0, 0, " << -0.02 * s * s * s << ", " << tip * s * s + twist << "\n";
    }
  return path;
}

using test::volume_of;

Vec3 normal_of(const TriMesh& mesh, TriangleId t) {
  const TriangleVertices& v = mesh.triangles[t];
  return cross(mesh.points[v[1]] - mesh.points[v[0]], mesh.points[v[2]] - mesh.points[v[0]]);
}

/// Returns the same mesh evaluated on another model with the same faces.
TriMesh reevaluated(const SurfaceMesh& surface, const Model& model) {
  TriMesh result = surface.mesh;
  for (const VertexId v : result.points.ids()) result.points[v] = model.faces[surface.locations[v].face].surface->point(surface.locations[v].at);
  return result;
}

TEST(DeformedMesh, MeshedWingBendsByDisplacementFile) {
  STERNA_NEEDS_SHARED_DATA();
  const RunContext context({.threads = 2});
  const Model wing = io::read_cad(test::shared_data() / "cad" / "tigl_simplewing_simplewing.brep", {}, context).model;
  SurfaceMeshOptions options;
  options.sizes.max_edge = 0.1;
  const SurfaceMesh surface = mesh_model(wing, options, {}, context);
  const auto map = std::make_shared<RadialMap>(read_displacements(displacements(0.25)));
  const Model bent = deformed(wing, map, context);
  const TriMesh moved = reevaluated(surface, bent);
  EXPECT_EQ(moved.triangles, surface.mesh.triangles);
  EXPECT_EQ(moved.triangle_patch, surface.mesh.triangle_patch);
  for (const VertexId v : moved.points.ids())
    ASSERT_LE(distance(moved.points[v], map->point(surface.mesh.points[v])), 1e-6);  // for vertices on edges: the edge's tolerance
  double tip = 0.0;
  for (const Point& p : moved.points) tip = std::max(tip, p.z);
  EXPECT_NEAR(tip, 0.25, 0.05);
  for (const TriangleId t : moved.triangles.ids()) ASSERT_GT(dot(normal_of(moved, t), normal_of(surface.mesh, t)), 0.0);
  // The relative volume cut off by chords is unchanged.
  const double before = volume_of(surface.mesh) / model_measures(wing, context).total.volume,
               after = volume_of(moved) / model_measures(bent, context).total.volume;
  EXPECT_NEAR(after, before, 1e-3);
  EXPECT_NEAR(before, 1.0, 0.02);
}

TEST(DeformedMesh, FoldingDisplacementsAreRefusedWithLocation) {
  STERNA_NEEDS_SHARED_DATA();
  const Model wing = io::read_cad(test::shared_data() / "cad" / "tigl_simplewing_simplewing.brep", {}, RunContext()).model;
  const std::filesystem::path path = test::scratch() / "fold.txt";
  std::ofstream(path) << "0.5 0 0 0 0 0\n0.5 2 0 0 0 0\n0 1 0 0 0 0\n1 1 0 0 0 0\n0.5 1 1 0 0 0\n0.5 1 0 0 0.9 0\n0.5 1.4 0 0 -0.9 0\n";
  try {
    (void)deformed(wing, std::make_shared<RadialMap>(read_displacements(path)), RunContext());
    FAIL() << "folded space was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::self_intersection);
    EXPECT_THAT(error.what(), testing::HasSubstr("folds space"));
    ASSERT_FALSE(error.info().locations.empty());
    EXPECT_NEAR(error.info().locations[0].position.y, 1.2, 0.5);
  }
}

}  // namespace
}  // namespace sterna::surfmesh
