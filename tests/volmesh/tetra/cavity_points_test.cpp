#include <gtest/gtest.h>

#include <numbers>

#include "geom/math/measures.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"

namespace sterna::volmesh {
namespace {

using test::both;
using test::box;
using test::error_info_of;
using test::inside_out;
using test::transformed;

std::vector<Point> find(const TriMesh& wall) { return find_cavity_points(wall, RunContext{}); }

/// Winding number by solid angles (van Oosterom and Strackee 1983), independent of the rays used in the code.
double winding(const TriMesh& mesh, const Point& p) {
  double sum = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    const Vec3 x = a - p, y = b - p, z = c - p;
    const double l = norm(x), m = norm(y), n = norm(z);
    sum += 2.0 * std::atan2(dot(x, cross(y, z)), l * m * n + dot(x, y) * n + dot(y, z) * l + dot(z, x) * m);
  }
  return sum / (4.0 * std::numbers::pi);
}

TEST(FindCavityPoints, InsideOfSimpleBodies) {
  for (const TriMesh& wall : {test::cube(1), test::cube(5), test::sphere(1), test::sphere(7)}) {
    const auto points = find(wall);
    ASSERT_EQ(points.size(), 1u);
    EXPECT_NEAR(winding(wall, points[0]), 1.0, 1e-9);
  }
  EXPECT_TRUE(find(TriMesh{}).empty());
}

TEST(FindCavityPoints, WithRoomAroundThem) {
  const auto points = find(box({0, 0, 0}, {3, 2, 0.1}));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_NEAR(points[0].z, 0.05, 1e-12);  // halfway between top and bottom, and not nearer to the sides
  EXPECT_NEAR(points[0].x, 1.5, 1.45);
  EXPECT_NEAR(points[0].y, 1.0, 0.95);
}

TEST(FindCavityPoints, InEveryBodyInOrder) {
  TriMesh wall;
  for (int i = 0; i < 5; ++i) append(wall, transformed(i % 2 ? test::cube(2) : test::sphere(3), 0.4, {3.0 * i, 0, 0}));
  const auto points = find(wall);
  ASSERT_EQ(points.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(points[static_cast<std::size_t>(i)].x, 3.0 * i, 0.41);
    EXPECT_NEAR(winding(wall, points[static_cast<std::size_t>(i)]), 1.0, 1e-9);
  }
}

TEST(FindCavityPoints, InTouchingBoxes) {
  const TriMesh wall = both(both(box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1})), box({1, 1, 1}, {2, 2, 2}));
  const auto points = find(wall);
  ASSERT_EQ(points.size(), 3u);
  for (const Point& p : points) EXPECT_NEAR(winding(wall, p), 1.0, 1e-9);
}

TEST(FindCavityPoints, InRazorThinBodies) {
  for (const double thickness : {1e-3, 1e-6, 1e-9}) {
    for (const double shift : {0.0, 1e3}) {
      TriMesh wall = test::cube(7);
      // Bent and oblique, so that no coordinate has a simple value.
      for (Point& p : wall.points) p = {p.x - 0.3 * p.y + shift, p.y + 0.2 * p.x, shift + 0.3 * p.x * p.x + 0.1 * p.y + thickness * p.z};
      const auto points = find(wall);
      ASSERT_EQ(points.size(), 1u);
      // The point lies between top and bottom; interpolation of the bent surface is off by its sagitta, so use the heights of the triangles themselves.
      EXPECT_NEAR(winding(wall, points[0]), 1.0, 1e-3);
    }
  }
}

TEST(FindCavityPoints, OncePerSolidRegion) {
  const TriMesh hollow = both(test::sphere(4), inside_out(transformed(test::sphere(3), 0.7, {})));
  ASSERT_EQ(find(hollow).size(), 1u);
  EXPECT_NEAR(winding(hollow, find(hollow)[0]), 1.0, 1e-9);
  EXPECT_GT(norm(find(hollow)[0]), 0.55);
  // A body in the cavity of another body, and two cavities.
  const TriMesh russian = both(hollow, transformed(test::cube(2), 0.3, {-0.1, -0.1, -0.1}));
  const auto points = find(russian);
  ASSERT_EQ(points.size(), 2u);
  for (const Point& p : points) EXPECT_NEAR(winding(russian, p), 1.0, 1e-9);
  const TriMesh cheese =
      both(both(test::sphere(6), inside_out(transformed(test::sphere(2), 0.2, {0.4, 0, 0}))), inside_out(transformed(test::cube(1), 0.2, {-0.4, 0, 0})));
  EXPECT_EQ(find(cheese).size(), 1u);
}

TEST(FindCavityPoints, MovesWithTheBody) {
  const TriMesh wall = both(test::cube(3), transformed(test::sphere(3), 0.5, {2, 0, 0}));
  for (const double scale : {1e-6, 1e6}) {
    const TriMesh moved = transformed(wall, scale, Vec3{1e3, 1e3, 1e3} * scale);
    const auto points = find(moved);
    ASSERT_EQ(points.size(), 2u);
    for (const Point& p : points) EXPECT_NEAR(winding(moved, p), 1.0, 1e-6);
  }
}

TEST(FindCavityPoints, RejectsWhatIsNoSolid) {
  const ErrorInfo error = error_info_of([] { find(inside_out(test::cube(2))); });
  EXPECT_EQ(error.code, ErrorCode::not_orientable);
  EXPECT_EQ(error.locations.size(), 1u);
  EXPECT_EQ(error_info_of([] { find(both(test::sphere(3), transformed(test::sphere(2), 0.5, {}))); }).code, ErrorCode::not_orientable);
}

TEST(FindCavityPoints, SameForAnyNumberOfThreads) {
  TriMesh wall;
  for (int i = 0; i < 12; ++i) append(wall, transformed(test::sphere(2 + i % 4), 0.4, {1.0 * i, 0.1 * i, 0}));
  const auto first = find(wall);
  for (const int threads : {1, 2, 7}) EXPECT_EQ(find_cavity_points(wall, RunContext({.threads = threads})), first);
}

}  // namespace
}  // namespace sterna::volmesh
