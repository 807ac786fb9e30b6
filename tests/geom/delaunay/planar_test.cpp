#include "geom/delaunay/planar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geom/base/error.h"
#include "geom/delaunay/check_triangulation.h"
#include "geom/delaunay/insertion_order.h"
#include "tests/support/test_constants.h"

namespace sterna::delaunay {
namespace {

using test::k_context;

std::vector<Vec2> random_points(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<Vec2> points(n);
  for (Vec2& p : points) p = {uniform(random), uniform(random)};
  return points;
}

std::vector<Vec2> grid_points(int n) {
  std::vector<Vec2> points;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) points.push_back({0.1 * i, 0.1 * j});
  return points;
}

std::vector<Vec2> circle_points(int n, double radius) {
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) points.push_back({radius * std::cos(2 * std::numbers::pi * i / n), radius * std::sin(2 * std::numbers::pi * i / n)});
  return points;
}

void add_loop(std::vector<Segment>& segments, std::uint32_t first, std::uint32_t n) {
  for (std::uint32_t i = 0; i < n; ++i) segments.push_back({first + i, first + (i + 1) % n});
}

double total_area(const Triangulation& mesh) {
  double area = 0.0;
  for (const TriangleVertices& v : extract_triangles(mesh)) {
    const Vec2 &a = mesh.uv[v[0]], &b = mesh.uv[v[1]], &c = mesh.uv[v[2]];
    area += 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }
  return area;
}

std::int64_t n_points_of(const PlanarTriangulation& result) {
  std::int64_t n = 0;
  for (std::size_t i = 0; i < result.same_as.size(); ++i) n += result.same_as[i].index() == i ? 1 : 0;
  return n;
}

void expect_delaunay_of_hull(const PlanarTriangulation& result) {
  const TriangulationCheck check = check_triangulation(result.mesh);
  EXPECT_TRUE(check.is_valid()) << check.text();
  EXPECT_EQ(check.n_not_delaunay, 0) << check.text();
  EXPECT_EQ(check.euler_number(), 1);
  EXPECT_EQ(check.n_border_loops, 1);
  EXPECT_EQ(check.n_ghosts, check.n_border_edges);
  EXPECT_EQ(check.n_used_vertices, n_points_of(result));
}

TEST(InsertionOrder, IsAPermutationThatStaysNear) {
  const std::size_t n = 100000;
  const std::vector<Vec2> points = random_points(n, 21);
  std::vector<std::uint32_t> order = insertion_order(points);
  // The last round is half of all points along one curve. The mean step is about the spacing of n / 2 points, 0.0045; a curve with jumps has a far longer step.
  double way = 0.0;
  for (std::size_t i = n - n / 4; i < n; ++i) way += std::hypot(points[order[i]].x - points[order[i - 1]].x, points[order[i]].y - points[order[i - 1]].y);
  EXPECT_LT(way / static_cast<double>(n / 4), 1.5 * 0.0045);
  std::sort(order.begin(), order.end());
  for (std::uint32_t i = 0; i < n; ++i) ASSERT_EQ(order[i], i);
}

TEST(Planar, ThreePointsInAnyOrderAreOneTriangle) {
  const Vec2 a{0, 0}, b{1, 0}, c{0, 1};
  for (const auto& points : {std::vector<Vec2>{a, b, c}, {a, c, b}, {b, a, c}, {b, c, a}, {c, a, b}, {c, b, a}}) {
    const PlanarTriangulation result = triangulate_plane(points, {}, Extent::hull, k_context);
    EXPECT_EQ(extract_triangles(result.mesh).size(), 1u);
    expect_delaunay_of_hull(result);
  }
}

TEST(Planar, RandomPointsHaveEmptyCircles) {
  for (const std::size_t n : {4u, 5u, 10u, 100u, 3000u, 50000u}) expect_delaunay_of_hull(triangulate_plane(random_points(n, n), {}, Extent::hull, k_context));
}

TEST(Planar, StructuredAndCocircularPointsAreHandledExactly) {
  expect_delaunay_of_hull(triangulate_plane(grid_points(60), {}, Extent::hull, k_context));
  expect_delaunay_of_hull(triangulate_plane(circle_points(1000, 1.0), {}, Extent::hull, k_context));
  // Far from the origin, rounding makes points coincide and become collinear.
  for (const double shift : {1e3, 1e9, 1e14}) {
    std::vector<Vec2> points = random_points(2000, 7);
    for (Vec2& p : points) p = {p.x + shift, p.y + shift};
    expect_delaunay_of_hull(triangulate_plane(points, {}, Extent::hull, k_context));
  }
}

TEST(Planar, PointsAtTheSamePlaceBecomeOne) {
  std::vector<Vec2> points = random_points(500, 3);
  const std::vector<Vec2> copy = points;
  points.insert(points.end(), copy.begin(), copy.end());
  const PlanarTriangulation result = triangulate_plane(points, {}, Extent::hull, k_context);
  expect_delaunay_of_hull(result);
  EXPECT_EQ(n_points_of(result), 500);
  for (std::size_t i = 0; i < 500; ++i) EXPECT_EQ(result.same_as[i], result.same_as[i + 500]);
}

TEST(Planar, PointsOnALineHaveNoTriangle) {
  const std::vector<Vec2> points{{0, 0}, {1, 1}, {2, 2}, {1, 1}};
  const PlanarTriangulation result = triangulate_plane(points, {}, Extent::hull, k_context);
  EXPECT_TRUE(extract_triangles(result.mesh).empty());
  EXPECT_EQ(result.same_as[3], VertexId(1u));
  EXPECT_TRUE(extract_triangles(triangulate_plane({}, {}, Extent::inside, k_context).mesh).empty());
}

TEST(Planar, BordersWithHolesAndIslands) {
  std::vector<Vec2> points = circle_points(200, 4.0);
  std::vector<Segment> segments;
  add_loop(segments, 0, 200);
  for (const auto& [n, radius] : {std::pair{100u, 3.0}, {60u, 2.0}, {30u, 1.0}}) {
    const auto first = static_cast<std::uint32_t>(points.size());
    for (const Vec2& p : circle_points(static_cast<int>(n), radius)) points.push_back(p);
    add_loop(segments, first, n);
  }
  const PlanarTriangulation result = triangulate_plane(points, segments, Extent::inside, k_context);
  const TriangulationCheck check = check_triangulation(result.mesh);
  EXPECT_TRUE(check.is_valid()) << check.text();
  EXPECT_EQ(check.n_not_delaunay, 0);
  EXPECT_EQ(check.euler_number(), 0);  // two annuli
  EXPECT_EQ(check.n_border_loops, 4);
  EXPECT_EQ(check.n_border_edges, 390);
  EXPECT_EQ(check.n_constrained, 390);
  const auto polygon = [](double n, double r) { return 0.5 * n * r * r * std::sin(2 * std::numbers::pi / n); };
  EXPECT_NEAR(total_area(result.mesh), polygon(200, 4) - polygon(100, 3) + polygon(60, 2) - polygon(30, 1), 1e-12);
}

TEST(Planar, SegmentsThroughRandomPointsAreEdges) {
  // A comb of segments from side to side that cross many edges of the triangulation; every point on a segment splits the segment.
  std::vector<Vec2> points = random_points(4000, 11);
  std::vector<Segment> segments;
  for (int i = 0; i < 20; ++i) {
    const double y = (i + 0.5) / 20;
    const auto first = static_cast<std::uint32_t>(points.size());
    for (const Vec2& p : {Vec2{-0.1, y}, Vec2{1.1, y}, Vec2{0.25, y}, Vec2{0.5, y}}) points.push_back(p);
    segments.push_back({first, first + 1, false});
  }
  const PlanarTriangulation result = triangulate_plane(points, segments, Extent::hull, k_context);
  expect_delaunay_of_hull(result);
  for (const Segment& s : segments) {
    EXPECT_TRUE(find_edge(result.mesh, VertexId(s.from), VertexId(s.from + 2)).is_valid());
    EXPECT_TRUE(find_edge(result.mesh, VertexId(s.from + 2), VertexId(s.from + 3)).is_valid());
    EXPECT_TRUE(find_edge(result.mesh, VertexId(s.from + 3), VertexId(s.to)).is_valid());
  }
  EXPECT_EQ(check_triangulation(result.mesh).n_constrained, 60);
}

TEST(Planar, SegmentsInRandomDirectionsThatDoNotCross) {
  // Spokes: every segment goes from the circle to an inner ring, past a crowd of points, so that spikes and repeated flips occur.
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::vector<Vec2> points = random_points(300, seed);
    for (Vec2& p : points) p = {2 * p.x - 1, 2 * p.y - 1};
    std::vector<Segment> segments;
    const int n = 17;
    for (int i = 0; i < n; ++i) {
      const double angle = 0.1 + 2 * std::numbers::pi * i / n;
      const auto first = static_cast<std::uint32_t>(points.size());
      points.push_back({2 * std::cos(angle), 2 * std::sin(angle)});
      points.push_back({0.05 * std::cos(angle), 0.05 * std::sin(angle)});
      segments.push_back({first, first + 1, false});
    }
    const PlanarTriangulation result = triangulate_plane(points, segments, Extent::hull, k_context);
    expect_delaunay_of_hull(result);
    EXPECT_EQ(check_triangulation(result.mesh).n_constrained, n);
  }
}

TEST(Planar, CrossingSegmentsAreAnErrorWithThePlace) {
  const std::vector<Vec2> points{{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  const std::vector<Segment> segments{{0, 2}, {1, 3}};
  try {
    triangulate_plane(points, segments, Extent::hull, k_context);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::self_intersection);
    ASSERT_EQ(error.info().locations.size(), 1u);
    EXPECT_NEAR(distance(error.info().locations[0].position, {1, 1, 0}), 0.0, 1e-15);
    EXPECT_THAT(error.what(), testing::HasSubstr("two segments cross"));
  }
}

TEST(Planar, OverlappingSegmentsAndTwiceTheSameBorder) {
  // A square whose lower side is given in two overlapping pieces; a border segment given twice is not a border.
  const std::vector<Vec2> points{{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 0}, {2, 0}};
  const std::vector<Segment> square{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  std::vector<Segment> segments = square;
  segments.push_back({0, 5, false});
  const PlanarTriangulation result = triangulate_plane(points, segments, Extent::inside, k_context);
  EXPECT_NEAR(total_area(result.mesh), 9.0, 1e-14);
  EXPECT_EQ(check_triangulation(result.mesh).n_border_edges, 6);
  segments.insert(segments.end(), square.begin(), square.end());
  EXPECT_TRUE(extract_triangles(triangulate_plane(points, segments, Extent::inside, k_context).mesh).empty());
}

TEST(Planar, WrongInputIsAnError) {
  const std::vector<Vec2> points{{0, 0}, {1, 0}, {0, std::nan("")}};
  const std::vector<Vec2> good{{0, 0}, {1, 0}, {0, 1}};
  const std::vector<Segment> beyond{{0, 3}};
  const auto code = [](const auto& f) {
    try {
      f();
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::internal;
  };
  EXPECT_EQ(code([&] { triangulate_plane(points, {}, Extent::hull, k_context); }), ErrorCode::bad_argument);
  EXPECT_EQ(code([&] { triangulate_plane(good, beyond, Extent::hull, k_context); }), ErrorCode::bad_argument);
}

TEST(Planar, TheSameEachTime) {
  const std::vector<Vec2> points = random_points(20000, 5);
  const auto first = extract_triangles(triangulate_plane(points, {}, Extent::hull, k_context).mesh);
  EXPECT_EQ(first, extract_triangles(triangulate_plane(points, {}, Extent::hull, k_context).mesh));
}

TEST(Planar, MirroredAndScaledPointsHaveTheSameEdges) {
  const std::vector<Vec2> points = random_points(1000, 9);
  const std::size_t n = extract_triangles(triangulate_plane(points, {}, Extent::hull, k_context).mesh).size();
  for (const double scale : {0x1p-20, 0x1p20, -1.0}) {
    std::vector<Vec2> others = points;
    for (Vec2& p : others) p = {scale * p.x, p.y * std::abs(scale)};
    const PlanarTriangulation result = triangulate_plane(others, {}, Extent::hull, k_context);
    expect_delaunay_of_hull(result);
    EXPECT_EQ(extract_triangles(result.mesh).size(), n);
  }
}

}  // namespace
}  // namespace sterna::delaunay
