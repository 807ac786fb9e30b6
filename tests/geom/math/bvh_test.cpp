#include "geom/mesh/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "geom/base/error.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

RunContext with_threads(int threads) { return RunContext({.threads = threads}); }

std::vector<Box> random_boxes(std::size_t n, double size) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Box> boxes(n);
  for (Box& b : boxes) {
    const Vec3 p{uniform(random), uniform(random), uniform(random)};
    b.add(p);
    b.add(p + size * Vec3{uniform(random), uniform(random), uniform(random)});
  }
  return boxes;
}

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

Pairs brute_force_pairs(const std::vector<Box>& boxes) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (overlap(boxes[i], boxes[j])) pairs.push_back({i, j});
    }
  }
  return pairs;
}

TEST(BoxTree, PairsMatchBruteForceForAnyThreadCount) {
  for (const std::size_t n : {0u, 1u, 4u, 5u, 2000u}) {
    const std::vector<Box> boxes = random_boxes(n, 0.1);
    const Pairs expected = brute_force_pairs(boxes);
    for (const int threads : {1, 2, 7}) {
      const RunContext context = with_threads(threads);
      EXPECT_EQ(BoxTree(boxes, context).overlapping_pairs(context), expected) << n << " boxes, " << threads << " threads";
    }
  }
}

TEST(BoxTree, TreeIsTheSameForAnyThreadCount) {
  const std::vector<Box> boxes = random_boxes(40000, 0.01);
  const BoxTree one(boxes, with_threads(1));
  for (const int threads : {2, 7}) {
    const BoxTree other(boxes, with_threads(threads));
    ASSERT_TRUE(std::equal(one.order().begin(), one.order().end(), other.order().begin(), other.order().end()));
    ASSERT_EQ(one.nodes().size(), other.nodes().size());
    for (std::size_t i = 0; i < one.nodes().size(); ++i) {
      ASSERT_EQ(one.nodes()[i].first, other.nodes()[i].first);
      ASSERT_EQ(one.nodes()[i].box.min, other.nodes()[i].box.min);
      ASSERT_EQ(one.nodes()[i].box.max, other.nodes()[i].box.max);
    }
  }
}

TEST(BoxTree, ItemsInOneLeafNodesInTheirParent) {
  const std::vector<Box> boxes = random_boxes(777, 0.1);
  const BoxTree tree(boxes, with_threads(2));
  std::vector<int> count(boxes.size());
  for (const auto& node : tree.nodes()) {
    for (std::uint32_t j = node.first; j < node.first + node.count; ++j) ++count[tree.order()[j]];
    if (node.count > 0) continue;
    for (const std::uint32_t child : {node.first, node.first + 1}) {
      Box joined = node.box;
      joined.add(tree.nodes()[child].box);
      EXPECT_EQ(joined.min, node.box.min);
      EXPECT_EQ(joined.max, node.box.max);
    }
  }
  EXPECT_TRUE(std::all_of(count.begin(), count.end(), [](int c) { return c == 1; }));
}

TEST(BoxTree, EqualBoxesEmptyBoxesAndTouchingBoxes) {
  std::vector<Box> boxes(100);
  for (Box& b : boxes) b.add(Point{1, 2, 3});
  EXPECT_EQ(BoxTree(boxes, with_threads(2)).overlapping_pairs(with_threads(2)).size(), 100u * 99u / 2u);

  std::vector<Box> some(20);
  some[3].add(Point{0, 0, 0});
  some[3].add(Point{1, 1, 1});
  some[11].add(Point{1, 1, 1});
  some[11].add(Point{2, 2, 2});
  EXPECT_EQ(BoxTree(some, with_threads(1)).overlapping_pairs(with_threads(1)), (Pairs{{3, 11}}));
}

TEST(BoxTree, VisitStopsWhenTold) {
  const std::vector<Box> boxes = random_boxes(500, 0.2);
  const BoxTree tree(boxes, with_threads(1));
  int n = 0;
  tree.visit_overlaps(tree.nodes()[0].box, [&](std::uint32_t) { return ++n < 3; });
  EXPECT_EQ(n, 3);
}

TEST(BoxTree, RejectsBoxesThatAreNotFinite) {
  std::vector<Box> boxes = random_boxes(10, 0.1);
  boxes[7].max.y = std::numeric_limits<double>::infinity();
  try {
    const BoxTree tree(boxes, with_threads(1));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("box 7 is not finite"), std::string::npos) << error.what();
  }
}

TEST(TriangleTree, NearestMatchesBruteForce) {
  const TriMesh mesh = test::sphere(6, 2.0);
  const TriangleTree tree(mesh, with_threads(2));
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  for (int n = 0; n < 300; ++n) {
    Point p{uniform(random), uniform(random), uniform(random)};
    if (n % 10 == 0) p = mesh.points[VertexId(n % 100)];  // several triangles are equally near
    // The reference builds a tree of each single triangle.
    NearestHit expected;
    for (const TriangleId t : mesh.triangles.ids()) {
      TriMesh single;
      for (const Point& q : corners(mesh, t)) single.points.push_back(q);
      single.triangles.push_back({VertexId(0), VertexId(1), VertexId(2)});
      const NearestHit hit = TriangleTree(single, with_threads(1)).nearest(p);
      if (hit.distance < expected.distance) expected = {t, hit.point, hit.distance};
    }
    const NearestHit hit = tree.nearest(p);
    ASSERT_EQ(hit.triangle, expected.triangle);
    ASSERT_EQ(hit.distance, expected.distance);
    ASSERT_EQ(hit.point, expected.point);
    EXPECT_FALSE(tree.nearest(p, 0.9 * hit.distance - 1e-12).triangle.is_valid());
    EXPECT_EQ(tree.nearest(p, 1.1 * hit.distance).triangle, expected.triangle);
  }
}

TEST(TriangleTree, NearestPointOnFaceEdgeCornerZeroArea) {
  TriMesh mesh;
  for (const Point& p : {Point{0, 0, 0}, Point{4, 0, 0}, Point{0, 4, 0}}) mesh.points.push_back(p);
  mesh.triangles.push_back({VertexId(0), VertexId(1), VertexId(2)});
  const TriangleTree tree(mesh, with_threads(1));
  EXPECT_EQ(tree.nearest({1, 1, 5}).point, (Point{1, 1, 0}));
  EXPECT_EQ(tree.nearest({1, -3, 4}).point, (Point{1, 0, 0}));
  EXPECT_EQ(tree.nearest({1, -3, 4}).distance, 5.0);
  EXPECT_EQ(tree.nearest({7, -4, 0}).point, (Point{4, 0, 0}));
  EXPECT_EQ(tree.nearest({4, 4, 1}).point, (Point{2, 2, 0}));
  mesh.points[VertexId(2)] = {2, 0, 0};
  EXPECT_EQ(TriangleTree(mesh, with_threads(1)).nearest({3, 1, 0}).point, (Point{3, 0, 0}));
  EXPECT_FALSE(TriangleTree(TriMesh{}, with_threads(1)).nearest({}).triangle.is_valid());
}

TEST(TriangleTree, RaysFindEveryWallOfClosedSurface) {
  const TriMesh mesh = test::cube(5);
  const TriangleTree tree(mesh, with_threads(2));
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(0.05, 0.95);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 1000; ++n) {
    const Point p{uniform(random), uniform(random), uniform(random)};
    const Vec3 d{normal(random), normal(random), normal(random)};
    // The ray leaves through the nearest of the six planes.
    double expected = 1e300;
    for (std::size_t axis = 0; axis < 3; ++axis) expected = std::min(expected, ((d[axis] > 0 ? 1.0 : 0.0) - p[axis]) / d[axis]);
    const auto hits = tree.ray(p, d);
    ASSERT_FALSE(hits.empty());
    EXPECT_NEAR(hits.front().t, expected, 1e-12 * expected);  // rounding of a few operations
    EXPECT_NEAR(hits.back().t, expected, 1e-12 * expected);
  }
  // Rays through grid vertices and along edges hit every triangle there, on both walls.
  const auto hits = tree.ray({0.2, 0.4, -1.0}, {0, 0, 1});
  ASSERT_EQ(hits.size(), 12u);  // six triangles at each grid vertex
  EXPECT_NEAR(hits.front().t, 1.0, 1e-14);
  EXPECT_NEAR(hits.back().t, 2.0, 1e-14);
  EXPECT_TRUE(tree.ray({0.2, 0.4, -1.0}, {0, 0, -1}).empty());
}

TEST(TriangleTree, NoRayPassesBetweenTriangles) {
  TriMesh mesh = test::sphere(9, 3.0);
  for (Point& p : mesh.points) p = Point{0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, 1e-3 * p.z} + Point{31.7, -12.3, 5.1};
  const TriangleTree tree(mesh, with_threads(1));
  const Point inside{31.8, -12.2, 5.1001};
  // Rays to every vertex and to points of every edge hit the surface, wherever rounding puts the points.
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    for (const double s : {0.0, 0.5, 0.3141592653589793}) {
      const Vec3 d = c[0] + s * (c[1] - c[0]) - inside;
      const auto hits = tree.ray(inside, d);
      ASSERT_GE(hits.size(), s == 0.0 ? 5u : 2u) << t.value();
      EXPECT_NEAR(hits.front().t, 1.0, 1e-9);  // the surface is inclined to the ray by as little as 1e-3
    }
  }
}

TEST(TriangleTree, WindingNumberTellsInsideFromOutside) {
  const TriMesh one = test::sphere(12, 1.0);
  TriMesh two = one;
  append(two, test::sphere(7, 0.5));
  const TriangleTree single(one, with_threads(2));
  const TriangleTree nested(two, with_threads(2));
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  double worst = 0.0;
  for (int n = 0; n < 2000; ++n) {
    const double r = 0.001 * n;
    if (std::abs(r - 1.0) < 0.01 || std::abs(r - 0.5) < 0.01) continue;  // between the sphere and its chords
    const Point p = r * normalized({normal(random), normal(random), normal(random)});
    worst = std::max(worst, std::abs(single.winding_number(p) - (r < 1.0 ? 1.0 : 0.0)));
    worst = std::max(worst, std::abs(nested.winding_number(p) - (r < 0.5 ? 2.0 : r < 1.0 ? 1.0 : 0.0)));
  }
  EXPECT_LT(worst, 0.1);  // measured 0.047; 0.5 would be ambiguous
  RecordProperty("worst_error", std::to_string(worst));
}

TEST(TriangleTree, FarFieldAgreesWithSumOfSolidAngles) {
  // An open surface, so that the far field does not vanish: a fifth of a long thin ellipsoid.
  TriMesh mesh = test::sphere(20);
  mesh.triangles.raw().resize(mesh.n_triangles() / 5);
  for (Point& p : mesh.points) p = {8.0 * p.x, p.y, 0.3 * p.z};
  const TriangleTree tree(mesh, with_threads(2));
  std::mt19937_64 random(10);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  for (int n = 0; n < 300; ++n) {
    const Point p{8.0 * uniform(random), uniform(random), uniform(random)};
    double expected = 0.0;
    for (const TriangleId t : mesh.triangles.ids()) {
      // Solid angle: the excess of the spherical triangle's dihedral angles, with the sign of the volume.
      const auto c = corners(mesh, t);
      const Vec3 a = c[0] - p, b = c[1] - p, d = c[2] - p;
      const Vec3 ab = cross(a, b), bd = cross(b, d), da = cross(d, a);
      const double excess = angle_between(ab, -da) + angle_between(bd, -ab) + angle_between(da, -bd) - std::numbers::pi;
      expected += std::copysign(excess, dot(a, bd)) / (4.0 * std::numbers::pi);
    }
    EXPECT_NEAR(tree.winding_number(p), expected, 0.02);
  }
}

TEST(TriangleTree, RejectsCornersThatAreNotFinite) {
  TriMesh mesh = test::cube(1);
  const VertexId bad = mesh.triangles[TriangleId(0)][0];
  mesh.points[bad].z = std::nan("");
  try {
    const TriangleTree tree(mesh, with_threads(1));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_STREQ(error.what(), "building a triangle tree: a corner of triangle 0 is not finite");
  }
}

}  // namespace
}  // namespace sterna
