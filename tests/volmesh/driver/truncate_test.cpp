// Layers with fewer cells where the last cells have no room: two adjacent balls, whose gap shrinks to nearly zero.
#include <gtest/gtest.h>

#include <algorithm>

#include "io/file/volume_file.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/domain/room.h"
#include "tests/volmesh/domain/sharp_wing.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

/// Two balls of radius 1, as one wall, separated by `gap`.
TriMesh two_balls(double gap) {
  TriMesh wall = test::sphere(9), other = test::sphere(9);
  for (Point& p : other.points) p.x += 2.0 + gap;
  append(wall, other);
  return wall;
}

double box_height(const TriMesh& mesh) {
  double low = mesh.points[VertexId(0)].z, high = low;
  for (const Point& p : mesh.points) {
    low = std::min(low, p.z);
    high = std::max(high, p.z);
  }
  return high - low;
}

MeshCase ball_case(const char* truncate, int n_layers = 20) {
  MeshCase mesh_case = layers(n_layers, 1e-4);
  mesh_case.envelope.max_growth = 1.4;  // so that layers are tall enough to meet in gaps
  mesh_case.farfield.farfield_radius = 20.0;
  mesh_case.prisms.truncate = truncate;
  return mesh_case;
}

int largest_step(const LayerBlock& layers) {
  int step = 0;
  for (std::size_t c = 0; c < layers.n_columns(); ++c) {
    const auto [first, second, third] = layers.ends_of_column(c);
    const int shortest = first > 0 ? first : second > 0 ? second : third;
    step = std::max(step, third - shortest);
  }
  return step;
}

TEST(Truncation, GapsGetFewerTallerLayersOfSameHeight) {
  constexpr int k_many = 30;
  const TriMesh wall = two_balls(0.2);
  const VolumeMeshResult whole = volume_mesh(wall, ball_case("never", k_many), k_context);
  EXPECT_TRUE(whole.mesh.layers.is_uniform());
  EXPECT_EQ(whole.layer.truncated_area, 0.0);
  for (const char* const truncate : {"auto", "always"}) {
    SCOPED_TRACE(truncate);
    const VolumeMeshResult result = volume_mesh(wall, ball_case(truncate, k_many), k_context);
    ASSERT_TRUE(result.check.is_valid()) << to_text(result.check);
    EXPECT_TRUE(result.certificate.is_proved()) << to_text(result.certificate);
    const LayerBlock& layers = result.mesh.layers;
    EXPECT_FALSE(layers.is_uniform());
    EXPECT_EQ(largest_step(layers), 1);
    EXPECT_EQ(result.check.gate(Measure::layer_step).worst, 1.0);
    EXPECT_LE(result.check.gate(Measure::stack_growth).worst, 1.4 * 1.03);
    EXPECT_GT(count_cells(result.mesh).pyramids, 0);
    EXPECT_LT(count_cells(result.mesh).prisms, count_cells(whole.mesh).prisms);
    // No height is lost; the height of the layer is used better.
    EXPECT_NEAR(result.layer.coverage, whole.layer.coverage, 1e-3);
    EXPECT_NEAR(result.layer.mean_height, whole.layer.mean_height, 1e-3 * whole.layer.mean_height);
    EXPECT_GT(result.layer.interface.within, whole.layer.interface.within);
    // The truncated area is reported.
    EXPECT_GT(result.layer.truncated_area, 0.0);
    ASSERT_EQ(result.layer.patches.size(), 1u);
    EXPECT_NEAR(result.layer.patches[0].truncated, result.layer.truncated_area, 1e-9);
    EXPECT_EQ(result.layer.patches[0].least_layers, *std::ranges::min_element(layers.line_layers));
    EXPECT_EQ(result.mesh.request.line_layers, std::vector<std::uint16_t>(layers.n_lines(), k_many));
  }
}

TEST(Truncation, LayerWithRoomEverywhereDoesNotChange) {
  const TriMesh wall = test::sphere(6);
  const HybridMesh never = volume_mesh(wall, ball_case("never"), k_context).mesh, always = volume_mesh(wall, ball_case("always"), k_context).mesh;
  EXPECT_TRUE(always.layers.is_uniform());
  EXPECT_TRUE(always.request.line_layers.empty());
  EXPECT_EQ(always.points, never.points);
  EXPECT_EQ(always.tetrahedra, never.tetrahedra);
}

TEST(Truncation, ThreadsChangeNothing) {
  const TriMesh wall = two_balls(0.05);
  const HybridMesh one = volume_mesh(wall, ball_case("auto"), RunContext({.threads = 1})).mesh;
  for (const int threads : {2, 7}) {
    const HybridMesh many = volume_mesh(wall, ball_case("auto"), RunContext({.threads = threads})).mesh;
    EXPECT_EQ(many.points, one.points);
    EXPECT_EQ(many.layers.line_layers, one.layers.line_layers);
    EXPECT_EQ(many.tetrahedra, one.tetrahedra);
  }
}

TEST(Truncation, FilesKeepIt) {
  const HybridMesh mesh = volume_mesh(two_balls(0.05), ball_case("auto"), k_context).mesh;
  const auto path = test::scratch() / "balls.sterna";
  io::write_volume_file(mesh, path, k_context);
  const HybridMesh back = io::read_volume_file(path, k_context);
  EXPECT_EQ(back.layers.line_layers, mesh.layers.line_layers);
  EXPECT_EQ(back.request.line_layers, mesh.request.line_layers);
  EXPECT_EQ(to_json(check(back, {}, k_context)), to_json(check(mesh, {}, k_context)));
}

/// A wing from side to side of a room, one edge length above its floor: the layers of wing and floor end on the sides.
TriMesh room_with_low_wing() {
  return room([](const std::string& name) { return name == "floor" ? PatchKind::wall : PatchKind::slip; },
              [](int i, int, int k) { return i >= 8 && i < 14 && k >= 1 && k < 3; });
}

TEST(Truncation, StepsEndOnSidesInTriangles) {
  for (const bool is_periodic : {false, true}) {
    MeshCase mesh_case = layers(16, 1e-3);  // the layers need more than half of the gap
    mesh_case.prisms.truncate = "always";
    if (is_periodic) mesh_case.periodic = {{"left", "right"}};
    const VolumeMeshResult result = volume_mesh(room_with_low_wing(), mesh_case, k_context);
    ASSERT_TRUE(result.check.is_valid()) << to_text(result.check);
    EXPECT_EQ(largest_step(result.mesh.layers), 1);
    EXPECT_GT(result.layer.truncated_area, 0.0);
    EXPECT_EQ(result.check.periodic.size(), is_periodic ? 1u : 0u);
    EXPECT_GT(count_cells(result.mesh).pyramids, 0);
  }
}

TEST(Truncation, OpenedRidgesKeepTheirLayers) {
  MeshCase mesh_case = layers(12, 1e-3);
  mesh_case.farfield.farfield_radius = 10.0;
  mesh_case.ridges.open_ridges = "always";
  TriMesh wall = sharp_wing(30.0, 8);
  const TriMesh other = wall;  // a second wing, slightly above the first
  for (const Point& p : other.points) wall.points.push_back(p + Vec3{0.0, 0.0, 1.15 * box_height(other)});
  for (const TriangleVertices& v : other.triangles) {
    const auto shifted = [&](VertexId w) { return VertexId(w.index() + other.n_vertices()); };
    wall.triangles.push_back({shifted(v[0]), shifted(v[1]), shifted(v[2])});
    wall.triangle_patch.push_back(PatchId(0));
  }
  mesh_case.prisms.truncate = "always";
  const VolumeMeshResult result = volume_mesh(wall, mesh_case, k_context);
  ASSERT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_GT(result.layer.truncated_area, 0.0);
  EXPECT_GT(count_cells(result.mesh).hexahedra, 0);
}

TEST(Truncation, PatchesSayWhetherTheirLinesEndEarly) {
  TriMesh wall = two_balls(0.2);
  wall.patches = Column<PatchId, Patch>{{"left", PatchKind::wall}, {"right", PatchKind::wall}};
  for (const TriangleId t : wall.triangles.ids())
    if (corners(wall, t)[0].x > 1.0) wall.triangle_patch[t] = PatchId(1);
  MeshCase mesh_case = ball_case("never", 30);
  mesh_case.patches = {{.names = "right", .options = {{"truncate", "auto"}}}};
  const VolumeMeshResult result = volume_mesh(wall, mesh_case, k_context);
  EXPECT_TRUE(result.check.is_valid());
  ASSERT_EQ(result.layer.patches.size(), 2u);
  EXPECT_EQ(result.layer.patches[0].truncated, 0.0);
  EXPECT_GT(result.layer.patches[1].truncated, 0.0);
  mesh_case = ball_case("auto", 30);
  mesh_case.patches = {{.names = "*", .options = {{"truncate", "never"}}}};
  EXPECT_TRUE(volume_mesh(wall, mesh_case, k_context).mesh.layers.is_uniform());
}

}  // namespace
}  // namespace sterna::volmesh
