// Wraps of shapes and of torn real surfaces: every result is closed, manifold, without crossings, near the input, and documented in the report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>

#include "geom/mesh/bvh.h"
#include "io/file/surface_file.h"
#include "surfmesh/wrap/wrap_surface.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/tear.h"
#include "tests/surfmesh/soups.h"

namespace sterna::test {
namespace {

using surfmesh::WrapOptions;
using surfmesh::WrapResult;

WrapResult wrap(const std::vector<SurfaceSoup>& soups, const WrapOptions& options, int threads = 2) {
  return surfmesh::wrap_surface(soups, options, quiet(threads));
}

/// Returns a cube with six patches, one for each side.
TriMesh sided_cube(int n) {
  TriMesh mesh = cube(n);
  mesh.patches.clear();
  for (const char* name : {"x0", "x1", "y0", "y1", "z0", "z1"}) mesh.patches.push_back({name, PatchKind::wall});
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (middle[axis] == 0.0) mesh.triangle_patch[t] = PatchId(2 * axis);
      if (middle[axis] == 1.0) mesh.triangle_patch[t] = PatchId(2 * axis + 1);
    }
  }
  return mesh;
}

SurfaceSoup soup_with_patches(const TriMesh& mesh) { return tear(mesh, {.holes = 0, .gaps = 0, .missing = 0, .doubled = 0, .flipped = 0, .jitter = 0}); }

bool has_message(const WrapResult& result, const std::string& part) {
  return std::any_of(result.report.messages.begin(), result.report.messages.end(), [&](const std::string& m) { return m.find(part) != std::string::npos; });
}

/// Returns the distance of the farthest vertex of `mesh` from `surface`, m.
double farthest(const TriMesh& mesh, const TriMesh& surface) {
  const TriangleTree tree(surface, quiet());
  double d = 0.0;
  for (const Point& p : mesh.points) d = std::max(d, tree.nearest(p).distance);
  return d;
}

TEST(Wrap, ACubeKeepsItsEdgesCornersAndPatches) {
  const TriMesh given = sided_cube(4);
  const WrapResult result = wrap({soup_with_patches(given)}, {.edge = 0.08, .gap = 0.16});
  expect_stitched(result.mesh);
  EXPECT_NEAR(volume(result.mesh), 1.0, 0.01);
  EXPECT_LT(result.report.to_input, 0.008) << "the tolerance is a tenth of the edge";
  EXPECT_LT(farthest(result.mesh, given), 1e-9) << "every vertex is on the input";
  const TriangleTree tree(result.mesh, quiet());
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{corner & 1 ? 1.0 : 0.0, corner & 2 ? 1.0 : 0.0, corner & 4 ? 1.0 : 0.0};
    EXPECT_LT(tree.nearest(p).distance, 1e-9) << "corner " << corner;
  }
  EXPECT_GT(result.report.n_on_features, 12 * 8);
  ASSERT_EQ(result.mesh.patches.size(), 6u);
  std::array<double, 6> area{};
  for (const TriangleId t : result.mesh.triangles.ids()) {
    const auto c = corners(result.mesh, t);
    area[result.mesh.triangle_patch[t].index()] += triangle_area(c[0], c[1], c[2]);
  }
  for (const double a : area) EXPECT_NEAR(a, 1.0, 0.02);
  EXPECT_GT(result.report.quality.min_angle, 0.2) << "11 degrees, everywhere";
}

TEST(Wrap, TrianglesOfASmoothBodyAreGood) {
  const WrapResult result = wrap({soup_of(sphere(24))}, {.edge = 0.1, .gap = 0.2});
  expect_stitched(result.mesh);
  EXPECT_GT(result.report.quality.min_angle, 0.26) << "15 degrees";
  EXPECT_NEAR(volume(result.mesh), 4.0 / 3.0 * std::numbers::pi, 0.05);
}

TEST(Wrap, WhatIsInsideVanishesAndIsTold) {
  const SurfaceSoup inner = soup_of(sphere(6, 0.4), "inner.stl");
  const WrapResult result = wrap({soup_of(sphere(12)), inner}, {.edge = 0.15, .gap = 0.3});
  expect_stitched(result.mesh);
  EXPECT_EQ(result.report.n_components, 1);
  EXPECT_EQ(result.report.n_inside, static_cast<std::int64_t>(inner.triangles.size()));
  EXPECT_TRUE(has_message(result, "inside the wrap"));
}

TEST(Wrap, OverlappingBodiesJoinAndSeparateBodiesStay) {
  const WrapOptions options{.edge = 0.15, .gap = 0.3};
  EXPECT_EQ(wrap({joined(soup_of(sphere(10)), shifted(soup_of(sphere(10)), {1.0, 0.0, 0.0}))}, options).report.n_components, 1);
  const WrapResult apart = wrap({joined(soup_of(sphere(10)), shifted(soup_of(sphere(10)), {3.0, 0.0, 0.0}))}, options);
  expect_stitched(apart.mesh);
  EXPECT_EQ(apart.report.n_components, 2);
}

/// Returns a cube whose upper side has a square window of a quarter of its edge.
SurfaceSoup cube_with_window(double unit = 1.0) {
  SurfaceSoup soup = soup_of(cube(8));
  SurfaceSoup open = soup;
  open.triangles.clear();
  open.patch.clear();
  for (const auto& t : soup.triangles) {
    const Vec3 middle = (soup.points[t[0]] + soup.points[t[1]] + soup.points[t[2]]) / 3.0;
    if (middle.z == 1.0 && std::abs(middle.x - 0.5) < 0.125 && std::abs(middle.y - 0.5) < 0.125) continue;
    open.triangles.push_back(t);
    open.patch.push_back(0);
  }
  for (Vec3& p : open.points) p = unit * p;
  return open;
}

TEST(Wrap, OpeningsUpToGapCloseWiderOnesLeak) {
  const WrapResult closed = wrap({cube_with_window()}, {.edge = 0.06, .gap = 0.4, .half = "never"});
  expect_stitched(closed.mesh);
  EXPECT_NEAR(volume(closed.mesh), 1.0, 0.02);
  EXPECT_TRUE(closed.report.leaks.empty());
  ASSERT_GE(closed.report.closures.size(), 1u);
  EXPECT_TRUE(closed.report.closures[0].is_opening);
  EXPECT_LT(distance(closed.report.closures[0].position, {0.5, 0.5, 1.0}), 0.1);
  EXPECT_NEAR(closed.report.closures[0].size, 0.25, 0.15);
  EXPECT_TRUE(has_message(closed, "an opening"));

  const WrapResult leaking = wrap({cube_with_window()}, {.edge = 0.06, .gap = 0.12, .half = "never"});
  expect_stitched(leaking.mesh);
  ASSERT_EQ(leaking.report.leaks.size(), 1u);
  EXPECT_LT(distance(leaking.report.leaks[0].position, {0.5, 0.5, 1.0}), 0.35) << "a little behind the window";
  EXPECT_TRUE(has_message(leaking, "leak"));
}

/// Returns the part of a sphere beyond a plane; its boundary deviates from the plane by `rough`.
SurfaceSoup half_sphere(std::size_t axis, bool is_above, double rough) {
  const TriMesh mesh = sphere(16);
  SurfaceSoup soup;
  soup.source = "half.stl";
  soup.patch_names = {""};
  std::uint64_t k = 0;
  std::vector<Vec3> points(mesh.points.begin(), mesh.points.end());
  for (Vec3& p : points)
    if (std::abs(p[axis]) < 0.05) p[axis] = rough * std::sin(static_cast<double>(++k));
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto& v = mesh.triangles[t];
    const std::array<Vec3, 3> c{points[v[0].index()], points[v[1].index()], points[v[2].index()]};
    const double middle = (c[0][axis] + c[1][axis] + c[2][axis]) / 3.0;
    if ((is_above ? middle : -middle) > 2.0 * rough + 0.01) add_facet(soup, c[0], c[1], c[2]);
  }
  return soup;
}

TEST(Wrap, HalfModelsEndExactlyInTheirPlane) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double rough : {0.0, 1e-6, 1e-3}) {
      const bool is_above = axis != 1;
      const WrapResult result = wrap({half_sphere(axis, is_above, rough)}, {.edge = 0.15, .gap = 0.3});
      ASSERT_EQ(result.report.half_axis, std::string(1, "xyz"[axis])) << rough;
      EXPECT_TRUE(has_message(result, "half model"));
      EXPECT_LE(result.report.half_moved, 2.1 * rough + 1e-12);
      const Topology topology(result.mesh, quiet());
      EXPECT_GT(topology.n_boundary_halfedges(), 10u);
      for (std::uint32_t h = 0; h < topology.n_halfedges(); ++h)
        if (topology.is_boundary(HalfedgeId(h))) {
          EXPECT_EQ(result.mesh.points[topology.from(HalfedgeId(h))][axis], result.report.half_at);
        }
      const Box box = bounding_box(result.mesh);
      EXPECT_EQ(is_above ? box.min[axis] : box.max[axis], result.report.half_at);
      EXPECT_NEAR(area(result.mesh), 2.0 * std::numbers::pi, 0.1);
    }
}

TEST(Wrap, AutomaticGapIsTheLeastThatCloses) {
  SurfaceSoup soup = soup_of(cube(8)), open = soup;
  open.triangles.clear();
  open.patch.clear();
  for (const auto& t : soup.triangles) {
    const Vec3 middle = (soup.points[t[0]] + soup.points[t[1]] + soup.points[t[2]]) / 3.0;
    if (middle.z == 1.0 && middle.x > 0.5 && middle.x < 0.625 && middle.y > 0.5 && middle.y < 0.625) continue;
    open.triangles.push_back(t);
    open.patch.push_back(0);
  }
  const WrapResult closed = wrap({open}, {.edge = 0.0375, .half = "never"});
  expect_stitched(closed.mesh);
  EXPECT_TRUE(closed.report.leaks.empty());
  EXPECT_NEAR(volume(closed.mesh), 1.0, 0.02);
  EXPECT_EQ(closed.report.gap, 0.15) << "the window is 0.125 wide, twice the edge is 0.075";
  EXPECT_TRUE(has_message(closed, "openings are wider than 0.075 m: the gap is 0.15 m"));
}

TEST(Wrap, AutomaticGapWithoutClosureIsReportedOnce) {
  // A bowl: its opening is as wide as the bowl.
  const WrapResult bowl = wrap({half_sphere(2, false, 0.0)}, {.edge = 0.08, .half = "never"});
  expect_stitched(bowl.mesh);
  EXPECT_EQ(bowl.report.gap, 0.16) << "twice the edge: a wider one is of no use";
  EXPECT_TRUE(has_message(bowl, "the widest gap that is tried"));
  EXPECT_EQ(std::count_if(bowl.report.messages.begin(), bowl.report.messages.end(), [](const std::string& m) { return m.starts_with("openings are wider"); }),
            1);
  EXPECT_LT(std::abs(volume(bowl.mesh)), 0.1 * area(bowl.mesh) * bowl.report.edge + 0.3) << "a shell, not a body";
  EXPECT_NEAR(area(bowl.mesh), 4.0 * std::numbers::pi, 0.5) << "both sides";
}

TEST(Wrap, SheetEdgeLengthCountsBothSides) {
  TriMesh sheet;
  for (const Point& p : {Point{0, 0, 0}, Point{1, 0, 0}, Point{1, 1, 0}, Point{0, 1, 0}}) sheet.points.push_back(p);
  sheet.triangles.push_back({VertexId(0u), VertexId(1u), VertexId(2u)});
  sheet.triangles.push_back({VertexId(0u), VertexId(2u), VertexId(3u)});
  sheet.triangle_patch.assign(2, PatchId(0u));
  sheet.patches.push_back({"sheet", PatchKind::wall});
  const double edge = surfmesh::estimate_wrap(1.0, 1.0, {}).edge;
  const WrapResult result = wrap({soup_of(sheet)}, {.half = "never"});
  expect_stitched(result.mesh);
  EXPECT_NEAR(result.report.edge, std::sqrt(2.0) * edge, 0.05 * edge);
  EXPECT_TRUE(has_message(result, "both sides of sheets"));
}

TEST(Wrap, ATunnelIsWrappedFromWithin) {
  const WrapResult result = wrap({soup_of(cube(6))}, {.edge = 0.1, .gap = 0.2, .fluid = "inside"});
  const Topology topology(result.mesh, quiet());
  EXPECT_EQ(topology.n_boundary_halfedges(), 0u);
  EXPECT_NEAR(volume(result.mesh), -1.0, 0.02) << "normals into the fluid";
}

TEST(Wrap, UnitsScaleTheResult) {
  const WrapResult metres = wrap({cube_with_window()}, {.edge = 0.1, .gap = 0.4, .half = "never"});
  const WrapResult millimetres = wrap({cube_with_window(1000.0)}, {.edge = 0.1, .gap = 0.4, .half = "never", .unit = 1e-3});
  EXPECT_NEAR(volume(millimetres.mesh), volume(metres.mesh), 1e-3);
}

TEST(Wrap, AbsurdSizesAreRefusedWithFigures) {
  const std::vector<SurfaceSoup> soups{soup_of(cube(4))};
  expect_error(ErrorCode::bad_argument, "triangles", [&] { wrap(soups, {.edge = 1e-4}); });
  expect_error(ErrorCode::bad_argument, "max_triangles", [&] { wrap(soups, {.edge = 1e-4}); });
  expect_error(ErrorCode::bad_argument, "half the body length", [&] { wrap(soups, {.edge = 0.8}); });
  expect_error(ErrorCode::bad_argument, "gap = 3", [&] { wrap(soups, {.edge = 0.1, .gap = 3.0}); });
  expect_error(ErrorCode::bad_argument, "offset", [&] { wrap(soups, {.edge = 0.1, .offset = 0.3}); });
  expect_error(ErrorCode::empty_surface, "no facet", [&] { wrap({SurfaceSoup{.patch_names = {""}}}, {}); });
}

TEST(Wrap, EndsWhenItIsStopped) {
  std::stop_source stop;
  int n = 0;
  const RunContext context({.threads = 2, .stop = stop.get_token(), .progress = [&](const ProgressState&) {
                              if (++n == 3) stop.request_stop();
                            }});
  stop.request_stop();
  EXPECT_EQ(error_of([&] { surfmesh::wrap_surface({soup_of(sphere(16))}, {.edge = 0.02}, context); }).code(), ErrorCode::cancelled);
}

TEST(Wrap, TheSameBytesForAnyNumberOfThreads) {
  const SurfaceSoup torn = tear(sided_cube(16), {.seed = 3});
  const WrapResult one = wrap({torn}, {.edge = 0.06, .gap = 0.2}, 1);
  for (const int threads : {2, 7}) {
    const WrapResult more = wrap({torn}, {.edge = 0.06, .gap = 0.2}, threads);
    EXPECT_EQ(one.mesh.points, more.mesh.points) << threads;
    EXPECT_EQ(one.mesh.triangles, more.mesh.triangles) << threads;
    EXPECT_EQ(one.mesh.triangle_patch, more.mesh.triangle_patch) << threads;
    EXPECT_EQ(one.report.messages, more.report.messages) << threads;
  }
}

/// Number of torn surfaces. STERNA_TORN=200 selects the long form (target torn_long).
int n_torn() {
  const char* text = std::getenv("STERNA_TORN");
  return text ? std::atoi(text) : 5;
}

TEST(WrapTorn, ShapesTornAtRandomComeBack) {
  for (int seed = 1; seed <= n_torn(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const bool is_cube = seed % 2 == 0;
    const TriMesh whole = is_cube ? sided_cube(20) : sphere(20);
    const double length = body_length(whole);
    TearOptions how{.seed = static_cast<std::uint64_t>(seed)};
    how.missing = 0.02 * (seed % 7);
    how.holes = seed % 9;
    how.gaps = seed % 4;
    WrapResult result = wrap({tear(whole, how)}, {.edge = length / 20, .gap = 0.15 * length});
    expect_stitched(result.mesh);
    // Merged holes are wider than the gap (seeds 137 and 191): reported as a leak, and closed with the wider gap that the message recommends.
    if (!result.report.leaks.empty()) {
      EXPECT_GT(seed, 5);
      result = wrap({tear(whole, how)}, {.edge = length / 20, .gap = 0.3 * length});
      expect_stitched(result.mesh);
    }
    EXPECT_TRUE(result.report.leaks.empty());
    EXPECT_EQ(result.report.n_components, 1);
    EXPECT_LT(farthest(result.mesh, whole), 0.01 * length + how.jitter * length);
    EXPECT_NEAR(volume(result.mesh) / volume(whole), 1.0, 0.03);
    EXPECT_FALSE(result.report.messages.empty());
  }
}

TEST(WrapTorn, RealAircraft) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file : {"wing_body_79k.stl", "flow360_airplane_airplaneGeometry.stl"}) {
    SCOPED_TRACE(file);
    const TriMesh whole = stitch({io::read_surface_file(shared_data() / "surfaces" / "clean" / file, quiet())}, {.check_intersections = false}).mesh;
    const double length = body_length(whole);
    const WrapResult result = wrap({tear(whole, {.seed = 7})}, {.edge = 0.012 * length});
    expect_stitched(result.mesh);
    EXPECT_TRUE(result.report.leaks.empty());
    EXPECT_LT(result.report.to_input, 0.5 * result.report.edge);
    std::cout << file << ": to input " << result.report.to_input / length << " L, beyond " << result.report.n_beyond_tolerance << " of "
              << result.report.n_triangles << ", smallest angle " << result.report.quality.min_angle * 57.2958 << " deg\n";
  }
}

}  // namespace
}  // namespace sterna::test
