// Guarantees of remeshing, measured on the triangles: closed, manifold, no self-crossings, patches, features, angles, distance, identical bytes.
#include "surfmesh/remesh/remesh_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "geom/base/error.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"
#include "io/file/surface_file.h"
#include "surfmesh/remesh/remesh_demand.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna::surfmesh {
namespace {

using test::k_context;
using test::k_degree;

RemeshResult remeshed(const TriMesh& wall, const RemeshOptions& options = {}, std::vector<Rule> patches = {}, const SpaceSizes& requested = {}) {
  return remesh_surface(wall, options, patches, requested, k_context);
}

std::int64_t n_crossings(const TriMesh& mesh) { return find_crossings(mesh, k_context).total; }

/// Checks that the mesh is manifold (or Topology throws), has one fan per vertex, is closed like the input, has no crossings, and keeps the patches.
void expect_sound(const TriMesh& wall, const TriMesh& mesh) {
  const Topology before(wall, k_context), after(mesh, k_context);
  EXPECT_EQ(after.n_boundary_halfedges() == 0, before.n_boundary_halfedges() == 0);
  EXPECT_EQ(connected_components(mesh, after).count, connected_components(wall, before).count);
  const auto euler = [](const TriMesh& m, const Topology& t) {
    return static_cast<std::int64_t>(m.n_vertices()) - static_cast<std::int64_t>(t.n_halfedges() + t.n_boundary_halfedges()) / 2 +
           static_cast<std::int64_t>(m.n_triangles());
  };
  EXPECT_EQ(euler(mesh, after), euler(wall, before));
  EXPECT_EQ(n_crossings(mesh), 0);
  EXPECT_EQ(mesh.patches, wall.patches);
  EXPECT_EQ(std::set<PatchId>(mesh.triangle_patch.begin(), mesh.triangle_patch.end()),
            std::set<PatchId>(wall.triangle_patch.begin(), wall.triangle_patch.end()));
}

double farthest_from_sphere(const TriMesh& mesh, double radius) {
  double most = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    for (const Point& p : {a, b, c}) most = std::max(most, std::abs(norm(p) - radius));
  }
  return most;
}

/// Returns a wing of one airfoil, chord 1, span 4, of strips 4 long (sliver triangles). Patches: wing, tips. The trailing edge is sharp.
TriMesh strip_wing(int n) {
  TriMesh mesh;
  mesh.patches = Column<PatchId, Patch>{{"wing", PatchKind::wall}, {"tip", PatchKind::wall}};
  const auto half = [](double x) { return 0.6 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x); };
  std::vector<Point> section;
  for (int i = 0; i < 2 * n; ++i) {
    const double angle = test::k_pi * i / n, x = 0.5 * (1.0 + std::cos(angle));
    section.push_back({x, 0.0, (i == 0 || i == n) ? 0.0 : i < n ? half(x) : -half(x)});
  }
  for (const double y : {-2.0, 2.0})
    for (Point p : section) mesh.points.push_back({p.x, y, p.z});
  const auto at = [&](int side, int i) { return VertexId(side * 2 * n + (i % (2 * n))); };
  const auto add = [&](VertexId a, VertexId b, VertexId c, int patch) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangle_patch.push_back(PatchId(patch));
  };
  for (int i = 0; i < 2 * n; ++i) {
    add(at(0, i), at(1, i), at(1, i + 1), 0);
    add(at(0, i), at(1, i + 1), at(0, i + 1), 0);
  }
  for (int i = 0; i < n; ++i) {
    const int j = 2 * n - i;
    if (i > 0) {
      add(at(0, i), at(0, i + 1), at(0, j), 1);
      add(at(1, i), at(1, j), at(1, i + 1), 1);
    }
    if (i + 1 < n) {
      add(at(0, i + 1), at(0, j - 1), at(0, j), 1);
      add(at(1, i + 1), at(1, j), at(1, j - 1), 1);
    }
  }
  if (test::volume_of(mesh) < 0.0)
    for (TriangleVertices& v : mesh.triangles) std::swap(v[1], v[2]);
  return mesh;
}

TEST(RemeshSurface, CoarseSphereComesNearerToTheSphere) {
  for (const int f : {2, 4}) {
    const TriMesh wall = test::sphere(f, 2.0);
    const RemeshResult smooth = remeshed(wall, {.sizes = {.max_edge = 0.1}}), flat = remeshed(wall, {.sizes = {.max_edge = 0.1}, .smooth = false});
    expect_sound(wall, smooth.mesh);
    expect_sound(wall, flat.mesh);
    EXPECT_LT(farthest_from_sphere(smooth.mesh, 2.0), 0.1 * farthest_from_sphere(flat.mesh, 2.0));
    EXPECT_GT(smooth.report.min_angle, 20.0 * k_degree);
    EXPECT_GT(smooth.report.mean_radius_ratio, 0.93);
    EXPECT_EQ(smooth.report.n_slivers, 0);
    EXPECT_EQ(smooth.report.n_lines, 0);
    // Vertices of the flat mesh are on the given triangles.
    EXPECT_LT(flat.report.to_input.max, 0.02 * 2.0);
  }
}

TEST(RemeshSurface, EllipsoidHasShortEdgesAtItsEnds) {
  TriMesh wall = test::sphere(12);
  for (Point& p : wall.points) p = {4.0 * p.x, p.y, 0.5 * p.z};
  const RemeshResult result = remeshed(wall);
  expect_sound(wall, result.mesh);
  EXPECT_GT(result.report.min_angle, 20.0 * k_degree);
  EXPECT_LT(result.report.to_input.max, 0.01 * result.report.length);
  EXPECT_LT(result.report.from_input.max, 0.01 * result.report.length);
  const auto longest_near = [&](const Point& p) {
    double longest = 0.0;
    for (const TriangleId t : result.mesh.triangles.ids()) {
      const auto [a, b, c] = corners(result.mesh, t);
      if (distance(a, p) < 0.3) longest = std::max({longest, distance(a, b), distance(b, c)});
    }
    return longest;
  };
  EXPECT_LT(longest_near({4.0, 0.0, 0.0}), 0.7 * longest_near({0.0, 0.0, 0.5}));
  EXPECT_NEAR(test::volume_of(result.mesh), 4.0 / 3.0 * test::k_pi * 2.0, 0.02 * 4.0 / 3.0 * test::k_pi * 2.0);
}

TEST(RemeshSurface, BoxStaysABox) {
  const TriMesh wall = test::cube(1);
  const RemeshResult result = remeshed(wall, {.sizes = {.max_edge = 0.1}});
  expect_sound(wall, result.mesh);
  EXPECT_EQ(result.report.n_lines, 12);
  EXPECT_EQ(result.report.n_corners, 8);
  EXPECT_LT(result.report.to_input.max, 1e-12);
  EXPECT_LT(result.report.from_input.max, 1e-12);
  EXPECT_NEAR(test::volume_of(result.mesh), 1.0, 1e-12);
  EXPECT_GT(result.report.min_angle, 20.0 * k_degree);
  // 6 m^2 of triangles with edges of 0.1 m.
  EXPECT_NEAR(static_cast<double>(result.mesh.n_triangles()), 6.0 / (0.433 * 0.01), 400.0);
}

TEST(RemeshSurface, WingSliversAreRemovedAndEdgesStay) {
  const TriMesh wall = strip_wing(24);
  const RemeshResult result = remeshed(wall);
  expect_sound(wall, result.mesh);
  EXPECT_GT(result.report.angle_quantile_1, 20.0 * k_degree);
  EXPECT_LT(result.report.to_input.max, 2e-3 * result.report.length);
  EXPECT_LT(result.report.from_input.max, 2e-3 * result.report.length);
  // Vertices lie exactly on the trailing edge, along all of it.
  std::vector<double> along;
  for (const Point& p : result.mesh.points)
    if (std::abs(p.x - 1.0) < 1e-12 && std::abs(p.z) < 1e-12) along.push_back(p.y);
  std::sort(along.begin(), along.end());
  ASSERT_GT(along.size(), 10u);
  EXPECT_EQ(along.front(), -2.0);
  EXPECT_EQ(along.back(), 2.0);
  // Tips stay plane and keep their patch.
  for (const TriangleId t : result.mesh.triangles.ids()) {
    if (result.mesh.triangle_patch[t] != PatchId(1)) continue;
    for (const Point& p : corners(result.mesh, t)) EXPECT_EQ(std::abs(p.y), 2.0);
  }
}

/// Checks that the first row beside a straight line along y, away from its ends, has the requested height.
void expect_first_row(const TriMesh& mesh, double x, double height) {
  int n = 0;
  const auto is_on = [&](const Point& q) { return std::hypot(q.x - x, q.z) < 1e-9; };
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto p = corners(mesh, t);
    if (std::ranges::none_of(p, is_on) || std::abs(p[0].y) > 1.5) continue;
    for (const Point& q : p) {
      if (is_on(q)) continue;
      EXPECT_NEAR(std::hypot(q.x - x, q.z), height, 0.05 * height) << "y = " << q.y;
      ++n;
    }
  }
  EXPECT_GT(n, 100);
}

TEST(RemeshSurface, RowsAtTheTrailingEdge) {
  const TriMesh wall = strip_wing(24);
  const RemeshResult plain = remeshed(wall), result = remeshed(wall, {.sizes = {.trailing_edge_chordwise = 0.002, .trailing_edge_stretch = 12.0}});
  expect_sound(wall, result.mesh);
  EXPECT_LT(result.report.to_input.max, 2e-3 * result.report.length);
  EXPECT_LT(result.report.from_input.max, 2e-3 * result.report.length);
  const RowReport& rows = result.report.rows;
  EXPECT_TRUE(rows.notes.empty());
  EXPECT_EQ(plain.report.rows.n_triangles, 0);
  EXPECT_GT(rows.n_columns, 200);
  EXPECT_EQ(rows.n_without, 0);
  EXPECT_GT(rows.n_triangles, 2 * 8 * rows.n_columns);
  EXPECT_LT(rows.max_stretch, 12.0 * 1.4);
  expect_first_row(result.mesh, 1.0, 0.002);
}

TEST(RemeshSurface, RowsAtNoses) {
  // The nose of the coarse wing is a kinked edge, the nose of the fine wing is smooth; in the refined wing no feature lies on the nose.
  TriMesh shifted = strip_wing(61);
  for (Point& p : shifted.points) p = {p.x + 0.05 * p.y * p.y, p.y, p.z};
  for (const TriMesh& wall : {strip_wing(24), strip_wing(60), shifted}) {
    const RemeshResult result = remeshed(wall, {.sizes = {.leading_edge_chordwise = 0.002}});
    expect_sound(wall, result.mesh);
    EXPECT_LT(result.report.to_input.max, 3e-3 * result.report.length);
    EXPECT_LT(result.report.from_input.max, 3e-3 * result.report.length);
    EXPECT_TRUE(result.report.rows.notes.empty());
    EXPECT_GT(result.report.rows.n_columns, 200);
    EXPECT_EQ(result.report.rows.n_without, 0);
    EXPECT_LT(result.report.rows.max_stretch, 10.0 * 1.4);
  }
  expect_first_row(remeshed(strip_wing(60), {.sizes = {.leading_edge_chordwise = 0.002}}).mesh, 0.0, 0.002);
  // Set by a patch's rule, and applied only there.
  const RemeshResult by_rule = remeshed(strip_wing(24), {}, {{.names = "wing", .options = {{"leading_edge_chordwise", 0.002}}}});
  EXPECT_GT(by_rule.report.rows.n_columns, 200);
}

TEST(RemeshSurface, RowsThatCannotBeAreTold) {
  const RemeshResult result = remeshed(test::sphere(8), {.sizes = {.leading_edge_chordwise = 0.01, .trailing_edge_chordwise = 0.01}});
  EXPECT_EQ(result.report.rows.n_triangles, 0);
  ASSERT_EQ(result.report.rows.notes.size(), 2u);
  EXPECT_THAT(result.report.rows.notes[0], testing::HasSubstr("no rows at trailing edges"));
  EXPECT_THAT(result.report.rows.notes[1], testing::HasSubstr("no rows at leading edges"));
}

TEST(RemeshSurface, ThinPlateKeepsItsSides) {
  TriMesh wall = test::cube(6);
  for (Point& p : wall.points) p.z *= 1e-3;
  const RemeshResult result = remeshed(wall, {.sizes = {.max_edge = 0.1, .min_edge = 0.1}});
  expect_sound(wall, result.mesh);
  EXPECT_NEAR(test::volume_of(result.mesh), 1e-3, 1e-12);
  EXPECT_LT(result.report.from_input.max, 1e-12);
}

TEST(RemeshSurface, SizesOfPatchesSourcesAndRefinement) {
  TriMesh wall = test::cube(2);
  wall.patches.push_back({"lid", PatchKind::wall});
  for (const TriangleId t : wall.triangles.ids()) {
    const auto [a, b, c] = corners(wall, t);
    if (a.z == 1.0 && b.z == 1.0 && c.z == 1.0) wall.triangle_patch[t] = PatchId(1);
  }
  const auto n_of = [](const TriMesh& mesh, PatchId patch) { return std::count(mesh.triangle_patch.begin(), mesh.triangle_patch.end(), patch); };
  const RemeshResult plain = remeshed(wall, {.sizes = {.max_edge = 0.1}});
  const RemeshResult ruled = remeshed(wall, {.sizes = {.max_edge = 0.1}}, {{.names = "l*", .options = {{"max_edge", 0.05}}}});
  expect_sound(wall, ruled.mesh);
  EXPECT_GT(n_of(ruled.mesh, PatchId(1)), 3 * n_of(plain.mesh, PatchId(1)));
  SpaceSizes requested;
  requested.regions = [](const Point& p, double slope) { return 0.01 + slope * distance(p, {0.5, 0.5, 0.0}); };
  const RemeshResult near = remeshed(wall, {.sizes = {.max_edge = 0.1}}, {}, requested);
  expect_sound(wall, near.mesh);
  double shortest = 1.0;
  for (const TriangleId t : near.mesh.triangles.ids()) {
    const auto [a, b, c] = corners(near.mesh, t);
    for (const double d : {distance(a, b), distance(b, c), distance(c, a)}) shortest = std::min(shortest, d);
  }
  EXPECT_LT(shortest, 0.015);
  EXPECT_GT(near.mesh.n_triangles(), plain.mesh.n_triangles() + 200);
  const RemeshResult fine = remeshed(wall, {.sizes = {.max_edge = 0.1, .refinement = 1.5}});
  EXPECT_NEAR(static_cast<double>(fine.mesh.n_triangles()) / static_cast<double>(plain.mesh.n_triangles()), 2.25, 0.3);
  const RemeshResult thin = remeshed(wall, {.sizes = {.max_edge = 0.2, .thickness_factor = 0.1}});
  EXPECT_GT(thin.mesh.n_triangles(), 2 * remeshed(wall, {.sizes = {.max_edge = 0.2}}).mesh.n_triangles());
}

TEST(RemeshSurface, HalfKeepsItsRim) {
  TriMesh wall = test::sphere(8), half;
  half.patches = wall.patches;
  std::map<VertexId, VertexId> ids;
  for (const TriangleId t : wall.triangles.ids()) {
    const auto [a, b, c] = corners(wall, t);
    if (a.y + b.y + c.y < 0.0) continue;
    TriangleVertices v;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [it, is_new] = ids.try_emplace(wall.triangles[t][k]);
      if (is_new) it->second = half.points.push_back(wall.points[wall.triangles[t][k]]);
      v[k] = it->second;
    }
    half.triangles.push_back(v);
    half.triangle_patch.push_back(PatchId(0));
  }
  const Topology border(half, k_context);
  for (std::size_t h = 0; h < border.n_halfedges(); ++h)
    if (border.is_boundary(HalfedgeId(h))) half.points[border.from(HalfedgeId(h))].y = 0.0;
  const RemeshResult result = remeshed(half, {.sizes = {.max_edge = 0.15}});
  expect_sound(half, result.mesh);
  const Topology topology(result.mesh, k_context);
  for (std::size_t h = 0; h < topology.n_halfedges(); ++h)
    if (topology.is_boundary(HalfedgeId(h))) {
      EXPECT_NEAR(result.mesh.points[topology.from(HalfedgeId(h))].y, 0.0, 1e-14);
    }
}

TEST(RemeshSurface, NoTriangleLiesInTheRimsPlane) {
  // Half of a spindle: two corners at pointed ends, where boundary edges meet at a small angle.
  TriMesh half;
  half.patches.push_back({.name = "wall"});
  constexpr int k_along = 10, k_around = 6;
  std::vector<VertexId> ids;
  for (int i = 0; i <= k_along; ++i)
    for (int j = 0; j <= k_around; ++j) {
      const double x = static_cast<double>(i) / k_along, r = 0.4 * x * (1.0 - x), v = std::numbers::pi * j / k_around;
      const bool is_end = i == 0 || i == k_along;
      if (is_end && j > 0) ids.push_back(ids.back());
      else ids.push_back(half.points.push_back({x, j == 0 || j == k_around || is_end ? 0.0 : r * std::sin(v), r * std::cos(v)}));
    }
  const auto at = [&](int i, int j) { return ids[static_cast<std::size_t>(i * (k_around + 1) + j)]; };
  const auto add = [&](VertexId a, VertexId b, VertexId c) {
    if (a == b || b == c || c == a) return;
    half.triangles.push_back({a, b, c});
    half.triangle_patch.push_back(PatchId(0));
  };
  for (int i = 0; i < k_along; ++i)
    for (int j = 0; j < k_around; ++j) {
      add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  for (const double edge : {0.02, 0.1, 0.3}) {
    const RemeshResult result = remeshed(half, {.sizes = {.max_edge = edge}});
    expect_sound(half, result.mesh);
    for (const TriangleVertices& v : result.mesh.triangles)
      EXPECT_FALSE(std::ranges::all_of(v, [&](VertexId k) { return std::abs(result.mesh.points[k].y) < 1e-6; })) << edge << " " << result.mesh.points[v[0]].x;
  }
}

TEST(RemeshSurface, SameBytesForAnyThreads) {
  const TriMesh wall = strip_wing(40);
  std::vector<TriMesh> meshes;
  const RemeshOptions options{.sizes = {.leading_edge_chordwise = 0.002, .trailing_edge_chordwise = 0.004}};
  for (const int threads : {1, 2, 7}) meshes.push_back(remesh_surface(wall, options, {}, {}, RunContext({.threads = threads})).mesh);
  for (const TriMesh& mesh : meshes) {
    EXPECT_EQ(mesh.points, meshes[0].points);
    EXPECT_EQ(mesh.triangles, meshes[0].triangles);
  }
}

TEST(RemeshSurface, UnreachableDemandEndsItEarly) {
  const TriMesh wall = test::sphere(8);
  const auto demanding = [&](const RemeshDemand& demand) { return remesh_surface(wall, {}, {}, {}, demand, k_context); };
  // Limits that are met: the result is the same as without limits.
  const RemeshResult free = remeshed(wall), met = demanding({.most_slivers = 0, .least_angle = 10.0 * k_degree});
  EXPECT_EQ(free.mesh.points, met.mesh.points);
  EXPECT_EQ(free.mesh.triangles, met.mesh.triangles);
  test::expect_error(ErrorCode::geometry_failed, "the new triangles have 0 sliver triangles, 0 % of the triangles",
                     [&] { demanding({.most_slivers = 0, .least_angle = 59.9 * k_degree}); });
  // A sphere of 8 squares a side lies inside the remeshed one by a hundredth of its diameter.
  test::expect_error(ErrorCode::geometry_failed, "from the input triangles, the limit is", [&] { demanding({.largest_distance = 1e-5}); });
  EXPECT_EQ(free.mesh.points, demanding({.largest_distance = 0.1}).mesh.points);
  test::expect_error(ErrorCode::geometry_failed, "of their edges from the input triangles", [&] { demanding({.largest_distance_of_edge = 1e-4}); });
  // Edges that span 40 degrees of a sphere with finer triangles.
  const TriMesh fine = test::sphere(24);
  test::expect_error(ErrorCode::geometry_failed, "of the area is turned by more than 10 degrees", [&] {
    remesh_surface(fine, {.sizes = {.max_edge = 0.7, .min_edge = 0.7, .curvature_angle = 1.0}}, {}, {}, {.more_turned = 0.005}, k_context);
  });
  // A blunt edge of two corners 1e-4 apart: corners are kept, so the slivers beside them remain.
  TriMesh wedge = test::cube(1);
  for (Point& p : wedge.points)
    if (p.x == 1.0) p.z = 1e-4 * p.z;
  ASSERT_GE(count_slivers(wedge).n, 2);
  test::expect_error(ErrorCode::geometry_failed, "corners of lines, which are kept, force",
                     [&] { remesh_surface(wedge, {}, {}, {}, {.most_slivers = 0.0, .least_angle = 0.0}, k_context); });
}

/// Returns a box of 1 m by 1e-12 m by 1e-12 m.
TriMesh line_like_box() {
  TriMesh box = test::cube(1);
  for (Point& p : box.points) p = {p.x, 1e-12 * p.y, 1e-12 * p.z};
  return box;
}

TEST(RemeshSurface, LineThinPiecesDoNotRefineEndlessly) {
  const TriMesh wall = line_like_box();
  const TriMesh mesh = remeshed(wall).mesh;
  expect_sound(wall, mesh);
  EXPECT_LE(mesh.n_triangles(), 100'000u);
}

TEST(RemeshSurface, EndlessHalvingIsErrorWithLocation) {
  const Error error = test::error_of([] { remeshed(line_like_box(), {.sizes = {.max_edge = 1e-7, .max_triangles = 20'000}}); });
  EXPECT_EQ(error.code(), ErrorCode::overflow);
  EXPECT_THAT(error.what(), testing::HasSubstr("halving long edges did not end"));
  ASSERT_EQ(error.info().locations.size(), 1u);
  EXPECT_NEAR(error.info().locations[0].position.x, 0.5, 0.5);
}

TEST(RemeshSurface, Refusals) {
  const TriMesh wall = test::cube(2);
  test::expect_error(ErrorCode::bad_argument, "none", [&] { remeshed(wall, {}, {{.names = "none", .options = {{"max_edge", 0.1}}}}); });
  test::expect_error(ErrorCode::bad_argument, "trailing_edge_cells", [&] {
    remeshed(wall, {}, {{.names = "cube", .options = {{"trailing_edge_cells", 5.0}}}});
  });
  test::expect_error(ErrorCode::overflow, "max_triangles", [&] { remeshed(wall, {.sizes = {.max_edge = 0.01, .max_triangles = 1000}}); });
  test::expect_error(ErrorCode::bad_argument, "positive", [&] { remeshed(wall, {.sizes = {.max_edge = -1.0}}); });
  test::expect_error(ErrorCode::empty_surface, "no triangles", [&] { remeshed(TriMesh{}); });
  TriMesh crossing = wall;
  TriMesh second = wall;
  for (Point& p : second.points) p += Vec3{0.3, 0.3, 0.3};
  append(crossing, second);
  test::expect_error(ErrorCode::self_intersection, "repair", [&] { remeshed(crossing); });
}

struct RealFile {
  const char* name;
  double distance;  ///< distance over the length, both ways: the current value plus a third
  RemeshOptions options = {};
};

class RemeshRealFile : public testing::TestWithParam<RealFile> {};

TEST_P(RemeshRealFile, IsSound) {
  STERNA_NEEDS_SHARED_DATA();
  const TriMesh wall = stitch_surface({io::read_surface_file(test::shared_data() / "surfaces" / GetParam().name, k_context)}, {}, k_context).mesh;
  const RemeshResult result = remeshed(wall, GetParam().options);
  expect_sound(wall, result.mesh);
  const RemeshReport& r = result.report;
  EXPECT_GT(r.mean_radius_ratio, 0.9);
  EXPECT_GT(r.angle_quantile_1, 15.0 * k_degree);
  EXPECT_LT(r.to_input.max, GetParam().distance * r.length);
  EXPECT_LT(r.from_input.max, GetParam().distance * r.length);
  EXPECT_LE(static_cast<double>(r.n_slivers), 0.005 * static_cast<double>(r.n_triangles));
  EXPECT_EQ(r.n_kept, 0);
}

INSTANTIATE_TEST_SUITE_P(Files, RemeshRealFile,
                         testing::Values(RealFile{"clean/wing_body_79k.stl", 1.3e-3}, RealFile{"clean/derived_crm_wb_dpw_coarse_full.off", 1e-3},
                                         RealFile{"clean/flowpanel_cessna_cessna.msh", 1e-3}, RealFile{"clean/meshpy_ka6d_ka-6d.ply", 6e-3},
                                         RealFile{"clean/cgal_data_anchor_dense.off", 5e-3},
                                         RealFile{
                                             "clean/drivaer_frontWheels.obj.gz", 2.5e-3, {.sizes = {.min_edge = 0.004, .curvature_angle = 20.0 * k_degree}}},
                                         RealFile{"nasty/axom_surf_naca0012.stl", 2.5e-3}));

}  // namespace
}  // namespace sterna::surfmesh
