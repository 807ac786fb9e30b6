// Boundary triangles split by the tet engine: the splits are carried down to the wall, through the whole pipeline.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/math/measures.h"
#include "tests/support/test_shapes.h"
#include "volmesh/stages.h"

namespace sterna::volmesh {
namespace {

MeshCase with_splits(const TriMesh& wall) {
  MeshCase options;
  options.envelope.layers = 8;
  options.envelope.first_height = 1e-4 * body_length(wall);
  options.farfield.farfield_radius = 5.0 * body_length(wall);
  options.tetrahedra.boundary_splits = "always";
  options.tetrahedra.radius_edge = 1.6;
  return options;
}

/// Area of the boundary triangles of each patch.
std::vector<double> patch_areas(const HybridMesh& mesh) {
  std::vector<double> areas(mesh.patches.size(), 0.0);
  for (const auto& t : mesh.boundary_triangles) {
    const Point &a = mesh.points[t.nodes[0]], &b = mesh.points[t.nodes[1]], &c = mesh.points[t.nodes[2]];
    areas[t.patch.index()] += 0.5 * norm(cross(b - a, c - a));
  }
  return areas;
}

/// A cube with a separate patch for each face, so that splits across patches would show.
TriMesh cube_of_patches() {
  TriMesh cube = test::cube(3);
  cube.patches = {};
  for (const char* name : {"x0", "x1", "y0", "y1", "z0", "z1"}) cube.patches.push_back({name, PatchKind::wall});
  for (const TriangleId t : cube.triangles.ids()) {
    const auto [a, b, c] = corners(cube, t);
    const Vec3 n = cross(b - a, c - a);
    const int axis = n.x != 0.0 ? 0 : n.y != 0.0 ? 1 : 2;
    const double sign = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    cube.triangle_patch[t] = PatchId(2 * axis + (sign > 0.0 ? 1 : 0));
  }
  return cube;
}

TEST(SplitLayer, NewVerticesOfSphereLieOnSphere) {
  const TriMesh wall = test::sphere(4);
  MeshCase options = with_splits(wall);
  options.sources.push_back({.kind = SourceKind::point, .from = {1.5, 0.1, 0.2}, .size = 0.1});  // the triangles of the sphere itself need no splits
  const Makers makers{
      .part_envelope = {}, .wall_envelope = {}, .true_surface = [](const Point& p, TriangleId, const std::array<double, 3>&) { return p / norm(p); }};
  const VolumeMeshResult result = watched_volume_mesh(wall, options, makers, {}, RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_GT(result.n_split_triangles, 0);
  EXPECT_GT(result.mesh.layers.n_lines(), wall.n_vertices());
  for (std::size_t line = 0; line < result.mesh.layers.n_lines(); ++line) {
    const double radius = norm(result.mesh.points[result.mesh.layers.node(static_cast<std::uint32_t>(line), 0)]);
    EXPECT_NEAR(radius, 1.0, 1e-14);
  }
  // The refined surface is nearer to the sphere than the flat triangles were.
  double flat_area = 0.0;
  for (const TriangleId t : wall.triangles.ids()) {
    const auto [a, b, c] = corners(wall, t);
    flat_area += 0.5 * norm(cross(b - a, c - a));
  }
  EXPECT_GT(patch_areas(result.mesh)[0], flat_area);
  EXPECT_LT(patch_areas(result.mesh)[0], 4.0 * std::numbers::pi);
}

TEST(SplitLayer, PatchesAreKeptAndFlatFacesStayFlat) {
  const TriMesh wall = cube_of_patches();
  const VolumeMeshResult result = volume_mesh(wall, with_splits(wall), RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_GT(result.mesh.layers.n_columns(), wall.n_triangles());
  const std::vector<double> areas = patch_areas(result.mesh);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(areas[i], 1.0, 1e-12) << i;
  EXPECT_TRUE(result.certificate.is_proved());
}

TEST(SplitLayer, SameBytesForAnyNumberOfThreads) {
  const TriMesh wall = test::sphere(3);
  const auto run = [&](int threads) { return volume_mesh(wall, with_splits(wall), RunContext({.threads = threads})).mesh; };
  const HybridMesh one = run(1);
  for (const int threads : {2, 7}) {
    const HybridMesh other = run(threads);
    EXPECT_EQ(one.points.raw(), other.points.raw());
    EXPECT_EQ(one.tetrahedra, other.tetrahedra);
  }
}

}  // namespace
}  // namespace sterna::volmesh
