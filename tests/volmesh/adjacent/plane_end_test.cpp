// Plane adjacent patches: sizes from 1e-3 to 100 m, slits, islands, tilted planes.
#include <gmock/gmock.h>

#include "geom/base/error.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"
#include "tests/volmesh/adjacent/end_cases.h"

namespace sterna::volmesh {
namespace {

using namespace test_ends;

using test::k_context;
const ConstraintPlane k_symmetry({0, 0, 0}, {0, 1, 0});

/// Returns a symmetrical aerofoil with a sharp trailing edge at (v = 1, u = 0), as a hole (clockwise in (u, v)), finer at the leading edge; `n` points per
/// side.
std::vector<Point> aerofoil_hole(const Map& map, double thickness, int n) {
  const auto half = [&](double x) {
    return 5.0 * thickness * (0.2969 * std::sqrt(x) - 0.1260 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
  };
  const auto at = [&](int i) { return 0.5 * (1.0 - std::cos(k_pi * i / n)); };
  // u is z, v is x. Clockwise in (u, v) means leading edge, then upper side (u > 0) ..., seen from +y with z to the right and x up.
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) points.push_back(map(i == 0 ? 0.0 : -half(at(i)), at(i)));
  for (int i = n; i > 0; --i) points.push_back(map(i == n ? 0.0 : half(at(i)), at(i)));
  return points;
}

std::vector<Point> half_disc(const Map& map, double radius, int n) {
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) points.push_back(map(radius * std::cos(2 * k_pi * i / n), radius * std::sin(2 * k_pi * i / n)));
  return points;
}

TEST(PlaneEnd, LargeSquareWithSmallRoundHole) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, rectangle(on_xz, -500, -500, 500, 500, 10, 10));
  add_loop(region, circle(on_xz, 0.1, 0.2, -0.16, 1000));
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  const EndFacts facts = expect_sound(region, result, 0.0);
  EXPECT_NEAR(facts.area, 1e6 - 0.5 * 1000 * 0.16 * 0.16 * std::sin(2 * k_pi / 1000), 1e-6);
  EXPECT_GT(facts.least_angle, 25.0);
  EXPECT_LT(facts.greatest_angle, 125.0);
  EXPECT_LT(facts.greatest_jump, 2.5);
  EXPECT_NEAR(facts.least_angle, result.min_angle * 180.0 / k_pi, 1e-9);
  // Graded: about 2 pi / (slope^2 sqrt(3) / 4) triangles for each factor e of distance, 13 of them 2 pi r / h = 1000 wide at first.
  EXPECT_LT(result.triangles.size(), 20'000u);
  for (const Point& p : result.new_points) EXPECT_EQ(p.y, 0.0);
}

TEST(PlaneEnd, AngleTargetIsMetWherePossible) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, rectangle(on_xz, -500, -500, 500, 500, 10, 10));
  add_loop(region, circle(on_xz, 0.1, 0.2, -0.16, 200));
  EndOptions none, some;
  none.size_growth = some.size_growth = 2.0;
  none.min_angle = 0.0;
  some.min_angle = 0.55;
  const double without = triangulate_adjacent(region, none, k_context).min_angle, with = triangulate_adjacent(region, some, k_context).min_angle;
  EXPECT_LT(without, with);
  EXPECT_GE(with, 0.9 * some.min_angle);
}

TEST(PlaneEnd, CoordinateOfAxisPlanesToTheBit) {
  const double where = 0.1 + 1e-17;
  const ConstraintPlane plane({5, where, 7}, {0, -1, 0});
  AdjacentRegion region{.surface = &plane, .name = "symmetry"};
  const Map map = [&](double u, double v) { return Point{u, where, v}; };
  add_loop(region, rectangle(map, 3, 1e4, 4, 1e4 + 1, 7, 7));
  add_loop(region, circle(map, 3.5, 1e4 + 0.5, -0.2, 40));
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  expect_sound(region, result, 0.0);
  for (const Point& p : result.new_points) EXPECT_EQ(p.y, where);
}

TEST(PlaneEnd, SharpAerofoilInDiscOf500Metres) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, half_disc(on_xz, 500.0, 64));
  add_loop(region, aerofoil_hole(on_xz, 0.12, 400));
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  const EndFacts facts = expect_sound(region, result, 0.0);
  EXPECT_GT(facts.least_angle, 20.0);
  EXPECT_LT(facts.greatest_jump, 3.0);
}

TEST(PlaneEnd, IslandsInHolesAndManyHoles) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, rectangle(on_xz, -3, -3, 3, 3, 20, 20));
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      if (i != 2 || j != 2) add_loop(region, circle(on_xz, i - 2, j - 2, -0.2 - 0.05 * i, 30 + 4 * j));
  add_loop(region, circle(on_xz, 0, 0, -0.45, 60));
  add_loop(region, circle(on_xz, 0, 0, 0.3, 40));
  add_loop(region, circle(on_xz, 0.05, 0, -0.1, 12));
  // A second region outside the first.
  add_loop(region, circle(on_xz, 10, 0, 1.0, 20));
  const EndFacts facts = expect_sound(region, triangulate_adjacent(region, {}, k_context), 0.0);
  EXPECT_GT(facts.least_angle, 20.0);
}

TEST(PlaneEnd, LoopsThatTouchInASharedPoint) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, rectangle(on_xz, -1, -1, 1, 1, 10, 10));
  // Two diamonds that share the origin.
  const auto p = [&](double u, double v) {
    region.points.push_back(on_xz(u, v));
    return static_cast<std::uint32_t>(region.points.size() - 1);
  };
  const std::uint32_t o = p(0, 0), a = p(-0.2, 0.2), b = p(-0.4, 0), c = p(-0.2, -0.2), d = p(0.2, -0.2), e = p(0.4, 0), f = p(0.2, 0.2);
  for (const auto& edge : {std::array{o, c}, {c, b}, {b, a}, {a, o}, {o, f}, {f, e}, {e, d}, {d, o}}) region.edges.push_back(edge);
  const EndFacts facts = expect_sound(region, triangulate_adjacent(region, {}, k_context), 0.0);
  EXPECT_NEAR(facts.area, 4.0 - 2 * 0.08, 1e-12);
  EXPECT_GT(facts.least_angle, 20.0);
}

TEST(PlaneEnd, NarrowGapsAndLongEdges) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, rectangle(on_xz, -5, -5, 5, 5, 10, 10));
  // Edges of 0.2 with a gap of 1e-3 between two bodies, and a gap of 0.01 to a third body.
  std::vector<Point> left = rectangle(on_xz, -1, 0, -0.0005, 1, 5, 5), right = rectangle(on_xz, 0.0005, 0, 1, 1, 5, 5),
                     low = rectangle(on_xz, -1, -1, 1, -0.01, 10, 5);
  for (std::vector<Point>* loop : {&left, &right, &low}) {
    std::reverse(loop->begin(), loop->end());
    add_loop(region, *loop);
  }
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  const EndFacts facts = expect_sound(region, result, 0.0);
  EXPECT_NEAR(facts.area, 100.0 - 2 * 0.9995 - 2 * 0.99, 1e-12);
  EXPECT_LT(facts.n_below_20, 60) << "in the gaps only";
  EXPECT_LT(result.triangles.size(), 5'000u);
}

TEST(PlaneEnd, SizesOfTheCallerHold) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, rectangle(on_xz, -1, -1, 1, 1, 8, 8));
  region.size = [](const Point& p) { return p.x > 0.3 ? 0.05 : 1.0; };
  const AdjacentTriangles fine = triangulate_adjacent(region, {}, k_context);
  expect_sound(region, fine, 0.0);
  std::size_t n_in = 0;
  for (const Point& p : fine.new_points) n_in += p.x > 0.3 ? 1 : 0;
  // 1.4 m^2 of triangles with sides of 0.05: one point per 0.00217 m^2, fewer near the coarse border.
  EXPECT_GT(n_in, 350u);
  region.size = [](const Point&) { return -1.0; };
  test::expect_error(ErrorCode::bad_argument, "the target edge length is -1.000000 m, must be positive",
                     [&] { (void)triangulate_adjacent(region, {}, k_context); });
}

TEST(PlaneEnd, ObliquePlaneFarFromTheOrigin) {
  const Vec3 n = normalized(Vec3{1, 2, -3}), x = normalized(cross(n, Vec3{0, 0, 1})), y = cross(n, x);
  const Point origin{10, 20, 30};
  const ConstraintPlane plane(origin, n);
  AdjacentRegion region{.surface = &plane, .name = "slip"};
  const Map map = [&](double u, double v) { return origin + u * x + v * y; };
  add_loop(region, rectangle(map, -5, -5, 5, 5, 10, 10));
  add_loop(region, circle(map, 1, 1, -0.5, 100));
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  const EndFacts facts = expect_sound(region, result, 1e-13);
  EXPECT_GT(facts.least_angle, 25.0);
}

TEST(PlaneEnd, AFlatOriginalIsAPlane) {
  TriMesh original;
  for (const Point& p : rectangle(on_xz, 0, 0, 1, 1, 1, 1)) original.points.push_back(p);
  original.triangles = {{VertexId(0u), VertexId(1u), VertexId(2u)}, {VertexId(0u), VertexId(2u), VertexId(3u)}};
  original.triangle_patch.resize(2, PatchId(0u));
  original.patches.push_back({"side", PatchKind::slip});
  const ConstraintTriangles surface(original, k_context);
  AdjacentRegion region{.surface = &surface, .original = &original, .name = "side"};
  add_loop(region, rectangle(on_xz, 0, 0, 1, 1, 8, 8));
  add_loop(region, circle(on_xz, 0.5, 0.5, -0.1, 30));
  const AdjacentTriangles result = triangulate_adjacent(region, {}, k_context);
  for (const Point& p : result.new_points) EXPECT_EQ(p.y, 0.0);
  const EndFacts facts = expect_sound(region, result, 1e-15);
  EXPECT_GT(facts.least_angle, 20.0);
  EXPECT_EQ(result.n_kept, 0);
  region.original = nullptr;
  test::expect_error(ErrorCode::bad_argument, "the surface is curved, but the patch as it was given (original) is missing",
                     [&] { (void)triangulate_adjacent(region, {}, k_context); });
}

TEST(PlaneEnd, SameBytesForAnyNumberOfThreads) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, half_disc(on_xz, 100.0, 64));
  add_loop(region, aerofoil_hole(on_xz, 0.12, 100));
  const AdjacentTriangles one = triangulate_adjacent(region, {}, RunContext({.threads = 1})),
                          seven = triangulate_adjacent(region, {}, RunContext({.threads = 7}));
  EXPECT_EQ(one.triangles, seven.triangles);
  EXPECT_EQ(one.new_points, seven.new_points);
}

TEST(PlaneEndErrors, FootprintsThatOverlapAreNamedWithTheirPlace) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, rectangle(on_xz, -3, -3, 3, 3, 20, 20));
  add_loop(region, circle(on_xz, 0, 0, -0.5, 60));
  add_loop(region, circle(on_xz, 0.9, 0, -0.5, 60));
  const ErrorInfo info = failure(region);
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_THAT(info.attempted, testing::HasSubstr("\"symmetry\""));
  ASSERT_FALSE(info.locations.empty());
  // They cross at z = 0.45, x = +-0.218.
  EXPECT_NEAR(info.locations[0].position.z, 0.45, 0.06);
  EXPECT_NEAR(std::abs(info.locations[0].position.x), 0.218, 0.06);
  EXPECT_FALSE(info.geometry.edges.empty());
}

TEST(PlaneEndErrors, FootprintBeyondTheBorder) {
  AdjacentRegion crossing{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(crossing, rectangle(on_xz, -3, -3, 3, 3, 20, 20));
  AdjacentRegion outside = crossing, within = crossing;
  add_loop(crossing, circle(on_xz, 2.8, 0, -0.5, 60));
  EXPECT_EQ(failure(crossing).code, ErrorCode::self_intersection);
  add_loop(outside, circle(on_xz, 4, 0, -0.5, 60));
  EXPECT_EQ(failure(outside).code, ErrorCode::self_intersection);
  add_loop(within, circle(on_xz, 0, 0, -0.5, 60));
  add_loop(within, circle(on_xz, 0, 0, -0.3, 60));
  const ErrorInfo info = failure(within);
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_EQ(info.n_locations, 120) << "the inner loop's edges: the region is on their other side";
}

TEST(PlaneEndErrors, TouchingInEdgeOrUnsharedPoints) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  add_loop(region, rectangle(on_xz, -3, -3, 3, 3, 6, 6));
  AdjacentRegion point = region;
  std::vector<Point> hole = rectangle(on_xz, 0, 0, 1, 3, 1, 3);
  std::reverse(hole.begin(), hole.end());
  add_loop(region, hole);
  EXPECT_EQ(failure(region).code, ErrorCode::self_intersection);
  add_loop(point, {on_xz(0, 3), on_xz(0.5, 2.5), on_xz(-0.5, 2.5)});
  const ErrorInfo info = failure(point);
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_THAT(info.problem, testing::HasSubstr("do not share"));
}

TEST(PlaneEndErrors, WrongInput) {
  AdjacentRegion region{.surface = &k_symmetry, .name = "symmetry"};
  EXPECT_EQ(failure(region).code, ErrorCode::bad_argument);
  add_loop(region, rectangle(on_xz, -3, -3, 3, 3, 6, 6));
  AdjacentRegion open = region, reversed = region, off = region, index = region, none = region, nothing = region;
  open.edges.pop_back();
  EXPECT_THAT(failure(open).problem, testing::HasSubstr("not closed"));
  EXPECT_EQ(failure(open).code, ErrorCode::bad_argument);
  EXPECT_EQ(failure(open).n_locations, 2);
  for (auto& edge : reversed.edges) std::swap(edge[0], edge[1]);
  EXPECT_THAT(failure(reversed).problem, testing::HasSubstr("wrong sense"));
  EXPECT_EQ(failure(reversed).code, ErrorCode::bad_argument);
  off.points[3].y = 1e-3;
  EXPECT_EQ(failure(off).code, ErrorCode::bad_argument);
  EXPECT_EQ(failure(off).locations.at(0).position, off.points[3]);
  index.edges.push_back({1, 1000});
  EXPECT_EQ(failure(index).code, ErrorCode::bad_argument);
  none.surface = nullptr;
  EXPECT_EQ(failure(none).code, ErrorCode::bad_argument);
  nothing.points[2].x = std::nan("");
  EXPECT_EQ(failure(nothing).code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace sterna::volmesh
