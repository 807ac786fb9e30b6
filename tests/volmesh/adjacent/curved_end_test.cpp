// Curved adjacent patches: meshed in one projection, or only in the neighbourhood of the footprint.
#include <gmock/gmock.h>

#include "geom/base/error.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/adjacent/end_cases.h"

namespace sterna::volmesh {
namespace {

using namespace test_ends;

using test::k_context;

/// Cylinder about x, radius 2, from x = 0 to 6: (u, v) = arc length about the axis, x. Normals point inwards.
Point on_tunnel(double u, double v) { return {v, -2.0 * std::sin(u / 2.0), -2.0 * std::cos(u / 2.0)}; }
const ConstraintCylinder k_tunnel({0, 0, 0}, {1, 0, 0}, 2.0);

/// Splits the quads of the map in two; with `is_closed` the last column is joined to the first. Counter-clockwise in (u, v).
TriMesh grid(const Map& map, double u0, double u1, int n_u, double v0, double v1, int n_v, bool is_closed) {
  TriMesh mesh;
  const int columns = is_closed ? n_u : n_u + 1;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j <= n_v; ++j) mesh.points.push_back(map(u0 + (u1 - u0) * i / n_u, v0 + (v1 - v0) * j / n_v));
  const auto id = [&](int i, int j) { return VertexId((i % columns) * (n_v + 1) + j); };
  for (int i = 0; i < n_u; ++i)
    for (int j = 0; j < n_v; ++j) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  mesh.patches.push_back({"tunnel", PatchKind::slip});
  mesh.triangle_patch.assign(mesh.n_triangles(), PatchId(0u));
  return mesh;
}

/// Adds all border half-edges of the mesh as edges of the region.
void add_border(AdjacentRegion& region, const TriMesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, int> half;
  for (const TriangleVertices& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) half[{t[k].value(), t[(k + 1) % 3].value()}] = 1;
  std::map<std::uint32_t, std::uint32_t> number;
  const auto point = [&](std::uint32_t v) {
    const auto [at, is_new] = number.emplace(v, static_cast<std::uint32_t>(region.points.size()));
    if (is_new) region.points.push_back(mesh.points[VertexId(v)]);
    return at->second;
  };
  for (const auto& [edge, one] : half)
    if (!half.contains({edge[1], edge[0]})) region.edges.push_back({point(edge[0]), point(edge[1])});
}

TEST(CurvedEnd, QuarterOfACylinderInItsProjection) {
  const TriMesh original = grid(on_tunnel, -1.57, 1.57, 16, 0, 6, 30, false);
  AdjacentRegion region{.surface = &k_tunnel, .original = &original, .name = "tunnel"};
  add_border(region, original);
  add_loop(region, circle(on_tunnel, 0.2, 2.0, -0.3, 200));
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  const EndFacts facts = expect_sound(region, result, 1e-12);
  EXPECT_EQ(result.n_kept, 0);
  EXPECT_GT(facts.least_angle, 24.0);
  // Triangles lie on chords: a little less than the area of the cylinder.
  EXPECT_NEAR(facts.area, 3.14 * 6.0 - 0.09 * k_pi, 0.02 * 18.8);
}

TEST(CurvedEnd, WholeTunnelKeepsTrianglesAwayFromFootprint) {
  const TriMesh original = grid(on_tunnel, 0, 4 * k_pi, 64, 0, 6, 30, true);
  AdjacentRegion region{.surface = &k_tunnel, .original = &original, .name = "tunnel"};
  add_border(region, original);
  add_loop(region, circle(on_tunnel, 0.2, 2.0, -0.3, 200));
  add_loop(region, circle(on_tunnel, 6.0, 3.0, -0.2, 50));
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  const EndFacts facts = expect_sound(region, result, 1e-12);
  EXPECT_GT(result.n_kept, 64 * 60 * 3 / 4);
  EXPECT_GT(facts.least_angle, 20.0);
  EXPECT_GT(result.min_angle, 20.0 * k_pi / 180.0);
}

TEST(CurvedEnd, CoarseTunnelIsCutNearLargeFootprint) {
  // The footprint spans 70 degrees, its edges 12. If re-meshing extends by three edge lengths around the footprint there is no projection; with a smaller
  // extent there is one.
  const TriMesh original = grid(on_tunnel, 0, 4 * k_pi, 48, 0, 6, 22, true);
  AdjacentRegion region{.surface = &k_tunnel, .original = &original, .name = "tunnel"};
  add_border(region, original);
  add_loop(region, circle(on_tunnel, 6.3, 2.0, -1.2, 18));
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  expect_sound(region, result, 1e-12);
  EXPECT_GT(result.n_kept, 48 * 44 / 3);
  EXPECT_GT(result.min_angle, 10.0 * k_pi / 180.0);
}

TEST(CurvedEnd, TheOriginalAsTriangles) {
  const TriMesh original = grid(on_tunnel, 0, 4 * k_pi, 48, 0, 6, 24, true);
  const ConstraintTriangles surface(original, k_context);
  AdjacentRegion region{.surface = &surface, .original = &original, .name = "tunnel"};
  add_border(region, original);
  std::vector<Point> footprint = circle(on_tunnel, 0.2, 2.0, -0.3, 60);
  for (Point& p : footprint) p = surface.closest(p);
  add_loop(region, footprint);
  const EndFacts facts = expect_sound(region, triangulate_adjacent(region, {}, k_context), 1e-12);
  EXPECT_GT(facts.least_angle, 20.0);
}

TEST(CurvedEnd, RimUnderTheLayerIsDropped) {
  // The patch was cut along the body (a square hole); the footprint of the layer surrounds that hole.
  TriMesh original = grid(on_tunnel, 0, 4 * k_pi, 96, 0, 6, 48, true);
  TriMesh cut = original;
  cut.triangles = Column<TriangleId, TriangleVertices>();
  for (const TriangleVertices& t : original.triangles) {
    const Point centre = (original.points[t[0]] + original.points[t[1]] + original.points[t[2]]) / 3.0;
    if (centre.z < 0.0 && std::abs(centre.y) < 0.26 && std::abs(centre.x - 3.0) < 0.5) continue;  // its edges are not edges of the region
    cut.triangles.push_back(t);
  }
  cut.triangle_patch.assign(cut.n_triangles(), PatchId(0u));
  AdjacentRegion region{.surface = &k_tunnel, .original = &cut, .name = "tunnel"};
  AdjacentRegion whole = region;
  add_border(region, original);
  // A thick layer that covers whole rings of triangles; fine and coarse.
  for (const int n : {300, 40}) {
    AdjacentRegion with = region;
    add_loop(with, circle(on_tunnel, 0.0, 3.0, -1.5, n));
    const AdjacentTriangles result = triangulate_adjacent(with, {}, k_context);
    const EndFacts facts = expect_sound(with, result, 1e-12);
    EXPECT_GT(facts.least_angle, 20.0) << n;
    EXPECT_NEAR(facts.area, 4 * k_pi * 6 - 2.25 * k_pi, 0.01 * 75) << n;
    EXPECT_GT(result.n_kept, 4000) << n;
  }
}

TEST(CurvedEnd, OriginalThatLooksTheOtherWay) {
  TriMesh original = grid(on_tunnel, 0, 4 * k_pi, 48, 0, 6, 24, true);
  for (TriangleVertices& t : original.triangles) std::swap(t[0], t[1]);
  AdjacentRegion region{.surface = &k_tunnel, .original = &original, .name = "tunnel"};
  add_border(region, original);
  add_loop(region, circle(on_tunnel, 0.2, 2.0, 0.3, 200));
  const ErrorInfo info = failure(region);
  EXPECT_EQ(info.code, ErrorCode::bad_argument);
  EXPECT_THAT(info.problem, testing::HasSubstr("normals"));
}

TEST(CurvedEnd, SphericalCapAndWholeSphere) {
  const TriMesh sphere = test::sphere(16);
  TriMesh inward = sphere;
  for (TriangleVertices& t : inward.triangles) std::swap(t[0], t[1]);
  TriMesh cap = inward;
  cap.triangles = Column<TriangleId, TriangleVertices>();
  for (const TriangleVertices& t : inward.triangles)
    if (std::min({inward.points[t[0]].z, inward.points[t[1]].z, inward.points[t[2]].z}) > 0.5) cap.triangles.push_back(t);
  cap.triangle_patch.assign(cap.n_triangles(), PatchId(0u));
  for (const TriMesh* original : {&cap, &inward}) {
    const ConstraintTriangles surface(*original, k_context);
    AdjacentRegion region{.surface = &surface, .original = original, .name = "far"};
    add_border(region, *original);
    // Seen from inside, against the normal, the orientation is reversed: counter-clockwise about +z is a hole.
    std::vector<Point> footprint;
    for (int i = 0; i < 50; ++i) footprint.push_back(surface.closest({0.1 + 0.2 * std::cos(2 * k_pi * i / 50), 0.2 * std::sin(2 * k_pi * i / 50), 0.95}));
    add_loop(region, footprint);
    const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
    const EndFacts facts = expect_sound(region, result, 1e-12);
    EXPECT_GT(facts.least_angle, 18.0);
    EXPECT_EQ(result.n_kept > 0, original == &inward);
  }
}

TEST(CurvedEnd, BoxTunnelAsOnePatchKeepsSharpEdges) {
  // Walls of a square tunnel of side 2 in one patch, x from 0 to 6; normals inwards.
  const Map wall = [](double u, double v) {
    const double w = std::fmod(u + 8.0, 8.0);
    return w < 2 ? Point{v, 1 - w, -1} : w < 4 ? Point{v, -1, w - 3} : w < 6 ? Point{v, w - 5, 1} : Point{v, 1, 7 - w};
  };
  const TriMesh original = grid(wall, 0, 8, 32, 0, 6, 24, true);
  const ConstraintTriangles surface(original, k_context);
  AdjacentRegion region{.surface = &surface, .original = &original, .name = "walls"};
  add_border(region, original);
  AdjacentRegion across = region;
  add_loop(region, circle(wall, 0.6, 3.0, -0.4, 60));
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  const EndFacts facts = expect_sound(region, result, 1e-12);
  EXPECT_EQ(result.n_kept, 3 * 8 * 24 * 2);
  EXPECT_GT(facts.least_angle, 20.0);
  EXPECT_NEAR(facts.area, 48.0 - 0.5 * 60 * 0.16 * std::sin(2 * k_pi / 60), 1e-9);
  // A footprint across the edge between two walls.
  std::vector<Point> over = circle(wall, 2.0, 3.0, -0.4, 60);
  add_loop(across, over);
  const ErrorInfo info = failure(across);
  EXPECT_EQ(info.code, ErrorCode::geometry_failed);
  EXPECT_THAT(info.problem, testing::HasSubstr("sharp edge"));
  EXPECT_FALSE(info.locations.empty());
  EXPECT_THAT(info.attempted, testing::HasSubstr("\"walls\""));
}

TEST(CurvedEnd, FootprintAroundTheTunnelHasNoProjection) {
  // For example a layer on the inlet's ring: a footprint all around the cylinder, in a patch that is too coarse to be cut open.
  const TriMesh original = grid(on_tunnel, 0, 4 * k_pi, 48, 0, 6, 4, true);
  AdjacentRegion region{.surface = &k_tunnel, .original = &original, .name = "tunnel"};
  add_border(region, original);
  std::erase_if(region.edges, [&](const auto& edge) { return region.points[edge[0]].x == 0.0; });
  std::vector<Point> ring;
  for (int i = 0; i < 48; ++i) ring.push_back(on_tunnel(4 * k_pi * i / 48, 0.1));
  add_loop(region, ring);
  const ErrorInfo info = failure(region);
  EXPECT_EQ(info.code, ErrorCode::geometry_failed);
  EXPECT_FALSE(info.locations.empty());
  EXPECT_FALSE(info.hint.empty());
}

}  // namespace
}  // namespace sterna::volmesh
