#include "geom/math/intersect.h"
#include "geom/mesh/find_crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "geom/base/error.h"
#include "geom/math/predicates.h"
#include "tests/geom/math/exact_reference.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

using Corners = std::array<Vec3, 3>;
using Indices = std::array<std::uint32_t, 3>;

// ---------------------------------------------------------------- reference: the intersection's extreme points in rational numbers

using test::BigRational;
struct RationalPoint {
  BigRational x, y, z;
};
RationalPoint rational(const Vec3& p) { return {BigRational(p.x), BigRational(p.y), BigRational(p.z)}; }
RationalPoint operator-(const RationalPoint& a, const RationalPoint& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
RationalPoint advance(const RationalPoint& p, const BigRational& s, const RationalPoint& d) { return {p.x + s * d.x, p.y + s * d.y, p.z + s * d.z}; }
BigRational inner(const RationalPoint& a, const RationalPoint& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
RationalPoint outer(const RationalPoint& a, const RationalPoint& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
bool is_zero(const RationalPoint& a) { return a.x == 0 && a.y == 0 && a.z == 0; }

bool is_on_segment(const RationalPoint& p, const RationalPoint& a, const RationalPoint& b) { return is_zero(outer(b - a, p - a)) && inner(p - a, p - b) <= 0; }
using RationalTriangle = std::array<RationalPoint, 3>;
bool is_in_triangle(const RationalPoint& p, const RationalTriangle& t) {
  const RationalPoint n = outer(t[1] - t[0], t[2] - t[0]);
  if (is_zero(n)) return is_on_segment(p, t[0], t[1]) || is_on_segment(p, t[1], t[2]) || is_on_segment(p, t[2], t[0]);
  if (inner(n, p - t[0]) != 0) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (inner(n, outer(t[(i + 1) % 3] - t[i], p - t[i])) < 0) return false;
  }
  return true;
}

/// Each extreme point of the intersection is a corner, or a point where an edge meets the other triangle's plane or one of its edges.
std::vector<RationalPoint> common_extreme_points(const RationalTriangle& a, const RationalTriangle& b) {
  std::vector<RationalPoint> candidates(a.begin(), a.end());
  candidates.insert(candidates.end(), b.begin(), b.end());
  const auto add_pierced = [&](const RationalTriangle& u, const RationalTriangle& v) {
    const RationalPoint n = outer(v[1] - v[0], v[2] - v[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const RationalPoint d = u[(i + 1) % 3] - u[i];
      const BigRational slope = inner(n, d);
      if (slope != 0) candidates.push_back(advance(u[i], inner(n, v[0] - u[i]) / slope, d));
    }
  };
  add_pierced(a, b);
  add_pierced(b, a);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const RationalPoint d = a[(i + 1) % 3] - a[i], e = b[(j + 1) % 3] - b[j];
      const RationalPoint n = outer(d, e);
      if (!is_zero(n)) candidates.push_back(advance(a[i], inner(outer(b[j] - a[i], e), n) / inner(n, n), d));
    }
  }
  std::erase_if(candidates, [&](const RationalPoint& p) { return !is_in_triangle(p, a) || !is_in_triangle(p, b); });
  return candidates;
}

bool reference_cross(const std::vector<Vec3>& points, const Indices& a, const Indices& b) {
  const auto triangle = [&](const Indices& t) { return RationalTriangle{rational(points[t[0]]), rational(points[t[1]]), rational(points[t[2]])}; };
  std::set<std::uint32_t> shared;
  for (const std::uint32_t v : a) {
    if (std::find(b.begin(), b.end(), v) != b.end()) shared.insert(v);
  }
  if (shared.size() == 3) return true;
  for (const RationalPoint& p : common_extreme_points(triangle(a), triangle(b))) {
    if (shared.empty()) return true;
    if (!is_on_segment(p, rational(points[*shared.begin()]), rational(points[*shared.rbegin()]))) return true;
  }
  return false;
}

// ---------------------------------------------------------------- tests

bool intersect_in_every_order(const Corners& a, const Corners& b, bool expected) {
  std::array<std::size_t, 3> o = {0, 1, 2};
  do {
    std::array<std::size_t, 3> q = {0, 1, 2};
    do {
      const Corners u = {a[o[0]], a[o[1]], a[o[2]]}, v = {b[q[0]], b[q[1]], b[q[2]]};
      if (triangles_intersect(u, v) != expected || triangles_intersect(v, u) != expected) return false;
    } while (std::next_permutation(q.begin(), q.end()));
  } while (std::next_permutation(o.begin(), o.end()));
  return true;
}

struct NamedPair {
  const char* name;
  Corners a, b;
  bool expected;
};

const Corners k_floor = {Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};

const std::vector<NamedPair>& hand_derived_pairs() {
  static const std::vector<NamedPair> pairs = {
      {"pierced", k_floor, {Vec3{1, 1, -1}, Vec3{1, 1, 1}, Vec3{9, 9, 0}}, true},
      {"an edge of each in the other", k_floor, {Vec3{1, 1, -1}, Vec3{1, 1, 1}, Vec3{-5, -5, 0}}, true},
      {"above", k_floor, {Vec3{0, 0, 1}, Vec3{4, 0, 1}, Vec3{0, 4, 2}}, false},
      {"planes cross, triangles apart", k_floor, {Vec3{3, 3, -1}, Vec3{3, 3, 1}, Vec3{9, 9, 0}}, false},
      {"corner touches face", k_floor, {Vec3{1, 1, 0}, Vec3{1, 1, 1}, Vec3{2, 2, 1}}, true},
      {"corner touches edge", k_floor, {Vec3{2, 2, 0}, Vec3{3, 3, 1}, Vec3{3, 3, 2}}, true},
      {"corner touches corner", k_floor, {Vec3{4, 0, 0}, Vec3{5, 0, 1}, Vec3{5, 1, 1}}, true},
      {"corner just off the edge", k_floor, {Vec3{2, std::nextafter(2.0, 3.0), 0}, Vec3{3, 3, 1}, Vec3{3, 3, 2}}, false},
      {"corner just above the face", k_floor, {Vec3{1, 1, 5e-20}, Vec3{1, 1, 1}, Vec3{2, 2, 1}}, false},
      {"edges cross in a point", k_floor, {Vec3{2, 0, -1}, Vec3{2, 0, 1}, Vec3{2, -3, 0}}, true},
      {"edge within the face", k_floor, {Vec3{1, 1, 0}, Vec3{2, 1, 0}, Vec3{1, 1, 2}}, true},
      {"edge across the face", k_floor, {Vec3{-1, 1, 0}, Vec3{9, 1, 0}, Vec3{1, 1, 2}}, true},
      {"edge in the plane, outside", k_floor, {Vec3{3, 3, 0}, Vec3{4, 3, 0}, Vec3{1, 1, 2}}, false},
      {"edges overlap", k_floor, {Vec3{1, 0, 0}, Vec3{6, 0, 0}, Vec3{1, -1, 2}}, true},
      {"edges on one line, apart", k_floor, {Vec3{5, 0, 0}, Vec3{6, 0, 0}, Vec3{1, -1, 2}}, false},
      {"coplanar, inside", k_floor, {Vec3{0.5, 0.5, 0}, Vec3{1, 0.5, 0}, Vec3{0.5, 1, 0}}, true},
      {"coplanar, star", k_floor, {Vec3{3, 3, 0}, Vec3{-1, 3, 0}, Vec3{3, -1, 0}}, true},
      {"coplanar, apart", k_floor, {Vec3{5, 5, 0}, Vec3{6, 5, 0}, Vec3{5, 6, 0}}, false},
      {"coplanar, apart though the boxes overlap", k_floor, {Vec3{3, 3, 0}, Vec3{4, 3, 0}, Vec3{3, 4, 0}}, false},
      {"coplanar, corner on edge", k_floor, {Vec3{2, 2, 0}, Vec3{4, 3, 0}, Vec3{3, 4, 0}}, true},
      {"coplanar, common edge", k_floor, {Vec3{4, 0, 0}, Vec3{0, 4, 0}, Vec3{4, 4, 0}}, true},
      {"segment through", k_floor, {Vec3{1, 1, -1}, Vec3{1, 1, 1}, Vec3{1, 1, 0.5}}, true},
      {"segment beside", k_floor, {Vec3{3, 3, -1}, Vec3{3, 3, 1}, Vec3{3, 3, 0}}, false},
      {"segment ends on the face", k_floor, {Vec3{1, 1, 0}, Vec3{1, 1, 1}, Vec3{1, 1, 2}}, true},
      {"segment in the plane, across", k_floor, {Vec3{-1, -1, 0}, Vec3{9, 9, 0}, Vec3{3, 3, 0}}, true},
      {"segment in the plane, outside", k_floor, {Vec3{3, 3, 0}, Vec3{9, 9, 0}, Vec3{5, 5, 0}}, false},
      {"segment in the plane, passes a corner", k_floor, {Vec3{5, -1, 0}, Vec3{3, 1, 0}, Vec3{4, 0, 0}}, true},
      {"point on the face", k_floor, {Vec3{1, 1, 0}, Vec3{1, 1, 0}, Vec3{1, 1, 0}}, true},
      {"point off the face", k_floor, {Vec3{1, 1, 1}, Vec3{1, 1, 1}, Vec3{1, 1, 1}}, false},
      {"segments cross", {Vec3{0, 0, 0}, Vec3{2, 2, 2}, Vec3{1, 1, 1}}, {Vec3{0, 2, 1}, Vec3{2, 0, 1}, Vec3{2, 0, 1}}, true},
      {"segments skew", {Vec3{0, 0, 0}, Vec3{2, 2, 2}, Vec3{1, 1, 1}}, {Vec3{0, 2, 2}, Vec3{2, 0, 1}, Vec3{2, 0, 1}}, false},
      {"segments on one line, touching", {Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{2, 2, 2}}, {Vec3{2, 2, 2}, Vec3{3, 3, 3}, Vec3{3, 3, 3}}, true},
      {"segments on one line, apart", {Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{2, 2, 2}}, {Vec3{3, 3, 3}, Vec3{5, 5, 5}, Vec3{4, 4, 4}}, false},
      {"two points, the same", {Vec3{1, 2, 3}, Vec3{1, 2, 3}, Vec3{1, 2, 3}}, {Vec3{1, 2, 3}, Vec3{1, 2, 3}, Vec3{1, 2, 3}}, true},
      {"two points", {Vec3{1, 2, 3}, Vec3{1, 2, 3}, Vec3{1, 2, 3}}, {Vec3{1, 2, 4}, Vec3{1, 2, 4}, Vec3{1, 2, 4}}, false},
  };
  return pairs;
}

TEST(TrianglesIntersect, HandDerivedCasesInEveryOrder) {
  for (const auto& [name, a, b, expected] : hand_derived_pairs()) EXPECT_TRUE(intersect_in_every_order(a, b, expected)) << name;
}

TEST(TrianglesIntersect, HandDerivedCasesMirroredTurnedMovedAndScaled) {
  for (const auto& [name, a, b, expected] : hand_derived_pairs()) {
    // At other scales, two of the cases are off by less than a unit in the last place.
    if (std::string(name).find("just") != std::string::npos) continue;
    for (const double scale : {1.0, 1e6, 0x1p-20}) {
      for (const double shift : {0.0, 1e3}) {
        for (int turn = 0; turn < 6; ++turn) {
          const auto map = [&](const Vec3& p) {
            const Vec3 q = turn % 3 == 0 ? p : turn % 3 == 1 ? Vec3{p.y, p.z, p.x} : Vec3{p.z, p.x, p.y};
            return scale * (turn < 3 ? q : Vec3{q.x, q.y, -q.z}) + Vec3{shift, -shift, shift};
          };
          const Corners u = {map(a[0]), map(a[1]), map(a[2])}, v = {map(b[0]), map(b[1]), map(b[2])};
          EXPECT_EQ(triangles_intersect(u, v), expected) << name << ", scale " << scale << ", shift " << shift << ", turn " << turn;
        }
      }
    }
  }
}

TEST(TrianglesCross, HandDerivedSharedCornersAndEdges) {
  const std::vector<Vec3> p = {{0, 0, 0},  {4, 0, 0},  {0, 4, 0}, {4, 4, 0}, {1, 1, 0}, {0, 0, 4},
                               {-4, 0, 0}, {0, -4, 0}, {2, 0, 0}, {9, 0, 0}, {1, 1, 3}, {-1, -1, 3}};
  const Indices floor = {0, 1, 2};
  const auto cross_both_ways = [&](const Indices& b) {
    const bool result = triangles_cross(p, floor, b);
    EXPECT_EQ(triangles_cross(p, b, floor), result);
    EXPECT_EQ(triangles_cross(p, {floor[2], floor[0], floor[1]}, {b[1], b[0], b[2]}), result);
    return result;
  };
  EXPECT_TRUE(cross_both_ways({0, 1, 2})) << "the same triangle";
  EXPECT_TRUE(cross_both_ways({0, 2, 1})) << "the same triangle, turned over";
  EXPECT_FALSE(cross_both_ways({1, 3, 2})) << "flat neighbour";
  EXPECT_FALSE(cross_both_ways({1, 0, 5})) << "folded neighbour";
  EXPECT_TRUE(cross_both_ways({0, 1, 4})) << "folded back onto the floor";
  EXPECT_FALSE(cross_both_ways({0, 1, 8})) << "no area, within the common edge";
  EXPECT_FALSE(cross_both_ways({0, 1, 9})) << "no area, longer than the common edge";
  EXPECT_FALSE(cross_both_ways({0, 6, 7})) << "flat, opposite sectors";
  EXPECT_FALSE(cross_both_ways({0, 6, 5})) << "one corner, beside";
  EXPECT_TRUE(cross_both_ways({0, 4, 5})) << "one corner, an edge within the floor";
  EXPECT_TRUE(cross_both_ways({0, 8, 5})) << "one corner, along an edge of the floor";
  EXPECT_TRUE(cross_both_ways({0, 3, 6})) << "flat, overlapping sectors";
  EXPECT_FALSE(cross_both_ways({5, 10, 11})) << "none, above";
  EXPECT_TRUE(cross_both_ways({0, 4, 4})) << "no area, within the floor";
  EXPECT_FALSE(cross_both_ways({0, 0, 5})) << "no area, upwards";
  EXPECT_FALSE(cross_both_ways({0, 0, 0})) << "a corner of the floor";
}

TEST(TrianglesCross, MatchesRationalIntersectionOnASmallGrid) {
  // On a grid of 3^3 or 4^3 points nearly all pairs are degenerate in some way, and many triangles have zero area.
  std::mt19937_64 random(21);
  std::array<std::array<int, 2>, 4> seen{};
  for (int n = 0; n < 6000; ++n) {
    std::uniform_int_distribution<int> coordinate(0, n % 2 == 0 ? 2 : 3);
    std::uniform_int_distribution<std::uint32_t> corner(0, 2);
    std::vector<Vec3> points(6);
    for (Vec3& p : points) p = {double(coordinate(random)), double(coordinate(random)), double(coordinate(random))};
    if (n % 5 == 0) {
      for (Vec3& p : points) p.z = 0.5 * (p.x + p.y);  // all in one plane
    }
    const Indices a = {0, 1, 2};
    Indices b = {3, 4, 5};
    for (int shared = n % 4; shared > 0; --shared) b[corner(random)] = corner(random);
    const bool expected = reference_cross(points, a, b);
    std::size_t n_shared = 0;
    for (const std::uint32_t v : a) n_shared += std::find(b.begin(), b.end(), v) != b.end();
    ++seen[n_shared][expected];
    const auto text = [&] {
      std::string s = "case " + std::to_string(n) + ", triangle " + std::to_string(b[0]) + " " + std::to_string(b[1]) + " " + std::to_string(b[2]);
      for (const Vec3& p : points) s.append(1, ' ').append(format_point(p));
      return s;
    };
    ASSERT_EQ(triangles_cross(points, a, b), expected) << text();
    ASSERT_EQ(triangles_cross(points, b, a), expected) << text();
    ASSERT_EQ(triangles_cross(points, {a[1], a[0], a[2]}, {b[2], b[0], b[1]}), expected) << text();
    for (Vec3& p : points) p = 0x1p-17 * Vec3{p.z, p.x, p.y} + Vec3{1000, -1000, 50};
    ASSERT_EQ(triangles_cross(points, a, b), expected) << text();
  }
  for (std::size_t n_shared = 0; n_shared < 3; ++n_shared) {
    EXPECT_GT(seen[n_shared][0], 100) << n_shared;
    EXPECT_GT(seen[n_shared][1], 100) << n_shared;
  }
}

TEST(TrianglesCross, MatchesRationalIntersectionOneUlpFromTouching) {
  std::mt19937_64 random(22);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int n_cross = 0;
  for (int n = 0; n < 600; ++n) {
    std::vector<Vec3> points(6);
    for (Vec3& p : points) p = {uniform(random), uniform(random), uniform(random)};
    // A corner of the second triangle is a rounded combination of the first triangle's corners: on the face, an edge or a corner, up to rounding.
    double s = uniform(random), t = n % 3 == 0 ? 0.0 : (1.0 - s) * uniform(random);
    if (n % 7 == 0) s = t = 0.0;
    points[3] = points[0] + s * (points[1] - points[0]) + t * (points[2] - points[0]);
    if (n % 2 == 0) points[4] = points[3] + 0.5 * (points[1] - points[0]);
    if (n % 4 == 0) points[5] = points[3] + 0.5 * (points[2] - points[0]);
    if (n % 5 == 0) points[3].x = std::nextafter(points[3].x, n % 10 == 0 ? 2.0 : -2.0);
    const Indices a = {0, 1, 2};
    const Indices b = {n % 11 == 0 ? 1u : 3u, 4, n % 13 == 0 ? 2u : 5u};
    const bool expected = reference_cross(points, a, b);
    n_cross += expected;
    ASSERT_EQ(triangles_cross(points, a, b), expected) << n;
    ASSERT_EQ(triangles_cross(points, b, a), expected) << n;
  }
  EXPECT_GT(n_cross, 100);
  EXPECT_LT(n_cross, 500);
}

struct Soup {
  std::vector<Vec3> points;
  std::vector<Indices> triangles;
};

Soup soup_of(const TriMesh& mesh) {
  Soup soup;
  soup.points = mesh.points.raw();
  for (const TriangleVertices& t : mesh.triangles) soup.triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  return soup;
}

Soup random_soup(std::size_t n_points, std::size_t n_triangles) {
  std::mt19937_64 random(23);
  std::uniform_int_distribution<int> coordinate(0, 12);
  std::uniform_int_distribution<std::uint32_t> vertex(0, static_cast<std::uint32_t>(n_points - 1));
  Soup soup;
  for (std::size_t i = 0; i < n_points; ++i) soup.points.push_back({double(coordinate(random)), double(coordinate(random)), double(coordinate(random))});
  std::sort(soup.points.begin(), soup.points.end(), [](const Vec3& a, const Vec3& b) { return a.x < b.x; });
  for (std::size_t i = 0; i < n_triangles; ++i) {
    const std::uint32_t v = vertex(random);
    const auto near = [&] { return std::min(static_cast<std::uint32_t>(n_points - 1), v + vertex(random) / 16); };
    soup.triangles.push_back({v, near(), near()});
  }
  return soup;
}

TEST(FindCrossings, MatchesBruteForceForAnyThreadsAndLimit) {
  const Soup soup = random_soup(300, 600);
  std::vector<std::array<std::uint32_t, 2>> expected;
  for (std::uint32_t i = 0; i < soup.triangles.size(); ++i) {
    for (std::uint32_t j = i + 1; j < soup.triangles.size(); ++j) {
      if (triangles_cross(soup.points, soup.triangles[i], soup.triangles[j])) expected.push_back({i, j});
    }
  }
  ASSERT_GT(expected.size(), 1000u);
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    const CrossingPairs all = find_crossings(soup.points, soup.triangles, context);
    EXPECT_EQ(all.pairs, expected);
    EXPECT_EQ(all.total, static_cast<std::int64_t>(expected.size()));
    for (const std::size_t limit : {0u, 1u, 17u, 700u}) {
      const CrossingPairs some = find_crossings(soup.points, soup.triangles, context, limit);
      EXPECT_EQ(some.total, static_cast<std::int64_t>(expected.size()));
      EXPECT_TRUE(some.pairs.size() == limit && std::equal(some.pairs.begin(), some.pairs.end(), expected.begin())) << limit;
    }
  }
}

/// Neighbours that fold over each other, in space and in one plane: the cheap test for neighbours must never miss a crossing.
TEST(FindCrossings, MatchesBruteForceOnCrumpledSurfaces) {
  std::mt19937 random(5);
  for (const bool is_flat : {false, true}) {
    for (const double noise : {0.02, 0.2}) {
      SCOPED_TRACE((is_flat ? "flat, noise " : "round, noise ") + std::to_string(noise));
      Soup soup = soup_of(test::sphere(6));
      std::uniform_real_distribution<double> shift(-noise, noise);
      for (Vec3& p : soup.points) {
        p += Vec3{shift(random), shift(random), shift(random)};
        if (is_flat) p.z = 0.25;
      }
      std::vector<std::array<std::uint32_t, 2>> expected;
      for (std::uint32_t i = 0; i < soup.triangles.size(); ++i)
        for (std::uint32_t j = i + 1; j < soup.triangles.size(); ++j)
          if (triangles_cross(soup.points, soup.triangles[i], soup.triangles[j])) expected.push_back({i, j});
      EXPECT_TRUE(expected.size() > 30 || (!is_flat && noise < 0.1)) << expected.size();
      EXPECT_EQ(find_crossings(soup.points, soup.triangles, RunContext()).pairs, expected);
    }
  }
}

TEST(FindCrossings, CleanSurfacesHaveNoneAndInterpenetratingOnesDo) {
  const RunContext context({.threads = 2});
  for (TriMesh mesh : {test::sphere(8), test::cube(6)}) {
    const Soup clean = soup_of(mesh);
    EXPECT_EQ(find_crossings(clean.points, clean.triangles, context).total, 0);
    TriMesh other = mesh;
    for (Point& p : other.points) p += Vec3{0.37, 0.21, 0.13};
    append(mesh, other);
    const Soup crossed = soup_of(mesh);
    const CrossingPairs found = find_crossings(crossed.points, crossed.triangles, context);
    EXPECT_GT(found.total, 20);
    for (const auto& [i, j] : found.pairs) EXPECT_NE(i < clean.triangles.size(), j < clean.triangles.size());
  }
  EXPECT_EQ(find_crossings({}, {}, context).total, 0);
}

std::string rejection(const std::vector<Vec3>& points, const std::vector<Indices>& triangles) {
  try {
    find_crossings(points, triangles, RunContext());
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    return error.what();
  }
  return "accepted";
}

TEST(FindCrossings, RejectsInvalidIndicesAndNonFinitePoints) {
  EXPECT_EQ(rejection(std::vector<Vec3>(3), {{0, 1, 2}, {0, 1, 3}}), "finding crossing triangles: triangle 1 refers to point 3 of 3");
  std::vector<Vec3> points(4);
  points[2].y = std::nan("");
  EXPECT_EQ(rejection(points, {{0, 1, 3}, {1, 2, 3}}), "finding crossing triangles: point 2 of triangle 1 is not finite");
  EXPECT_EQ(rejection(points, {{0, 1, 3}}), "accepted");  // only vertices used by triangles are checked
}

TEST(FindCrossings, StopsWhenCancelled) {
  std::stop_source source;
  source.request_stop();
  const Soup soup = soup_of(test::sphere(6));
  try {
    find_crossings(soup.points, soup.triangles, RunContext({.stop = source.get_token()}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace sterna
