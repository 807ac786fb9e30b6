// Adjacent patches for tests: loops, regions, and required properties of their triangles, counted without the code under test.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "geom/math/measures.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"
#include "volmesh/adjacent/adjacent_surface.h"

namespace sterna::volmesh::test_ends {

using test::k_pi;

/// (u, v) -> point of the surface.
using Map = std::function<Point(double, double)>;

inline Point on_xz(double u, double v) { return {v, 0.0, u}; }  // u = z, v = x: counter-clockwise about +y

/// Returns the error of a region; the test fails if there is none.
inline ErrorInfo failure(const AdjacentRegion& region) {
  return test::error_info_of([&] { triangulate_adjacent(region, {}, RunContext({.threads = 2})); });
}

/// Adds a closed loop through the points, in their order.
inline void add_loop(AdjacentRegion& region, const std::vector<Point>& points) {
  const auto first = static_cast<std::uint32_t>(region.points.size()), n = static_cast<std::uint32_t>(points.size());
  region.points.insert(region.points.end(), points.begin(), points.end());
  for (std::uint32_t i = 0; i < n; ++i) region.edges.push_back({first + i, first + (i + 1) % n});
}

/// Returns the points of a circle: counter-clockwise for a positive radius, clockwise (a hole) for a negative one; n > 0.
inline std::vector<Point> circle(const Map& map, double u, double v, double radius, int n) {
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) points.push_back(map(u + std::abs(radius) * std::cos(2 * k_pi * i / n), v + radius * std::sin(2 * k_pi * i / n)));
  return points;
}

/// Returns the points of a rectangle, counter-clockwise, with sides divided into n_u and n_v.
inline std::vector<Point> rectangle(const Map& map, double u0, double v0, double u1, double v1, int n_u, int n_v) {
  std::vector<Point> points;
  for (int i = 0; i < n_u; ++i) points.push_back(map(u0 + (u1 - u0) * i / n_u, v0));
  for (int i = 0; i < n_v; ++i) points.push_back(map(u1, v0 + (v1 - v0) * i / n_v));
  for (int i = 0; i < n_u; ++i) points.push_back(map(u1 + (u0 - u1) * i / n_u, v1));
  for (int i = 0; i < n_v; ++i) points.push_back(map(u0, v1 + (v0 - v1) * i / n_v));
  return points;
}

struct EndFacts {
  double area = 0.0;           ///< m^2
  double least_angle = 180.0;  ///< degrees
  double greatest_angle = 0.0;
  std::int64_t n_below_20 = 0;  ///< triangles
  double greatest_jump = 1.0;   ///< ratio of the longest edges of neighbouring triangles
};

/// Checks that border edges are those of the region, once each, in their orientation, that normals agree with those of the surface, and that new points lie on
/// it.
inline EndFacts expect_sound(const AdjacentRegion& region, const AdjacentTriangles& result, double tolerance) {
  EndFacts facts;
  std::vector<Point> points(region.points);
  points.insert(points.end(), result.new_points.begin(), result.new_points.end());
  for (const Point& p : result.new_points) EXPECT_NEAR(region.surface->inside_distance(p), 0.0, tolerance) << p.x << " " << p.y << " " << p.z;
  std::map<std::array<std::uint32_t, 2>, std::size_t> half;
  std::vector<double> longest;
  std::int64_t n_folded = 0;
  for (std::size_t t = 0; t < result.triangles.size(); ++t) {
    const auto& v = result.triangles[t];
    const Point &a = points.at(v[0]), &b = points.at(v[1]), &c = points.at(v[2]);
    facts.area += triangle_area(a, b, c);
    double least = 180.0;
    for (const double angle : {corner_angle(a, b, c), corner_angle(b, c, a), corner_angle(c, a, b)}) {
      least = std::min(least, angle * 180.0 / k_pi);
      facts.greatest_angle = std::max(facts.greatest_angle, angle * 180.0 / k_pi);
    }
    facts.least_angle = std::min(facts.least_angle, least);
    facts.n_below_20 += least < 20.0 ? 1 : 0;
    longest.push_back(std::max({distance(a, b), distance(b, c), distance(c, a)}));
    n_folded += dot(area_vector(a, b, c), region.surface->normal((a + b + c) / 3.0)) > 0.0 ? 0 : 1;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(half.emplace(std::array{v[k], v[(k + 1) % 3]}, t).second);
  }
  EXPECT_EQ(n_folded, 0);
  std::size_t n_border = 0;
  for (const auto& [edge, t] : half) {
    const auto twin = half.find({edge[1], edge[0]});
    if (twin == half.end()) ++n_border;
    else facts.greatest_jump = std::max(facts.greatest_jump, longest[t] / longest[twin->second]);
  }
  EXPECT_EQ(n_border, region.edges.size());
  for (const auto& edge : region.edges) {
    EXPECT_TRUE(half.contains(edge));
    EXPECT_FALSE(half.contains({edge[1], edge[0]}));
  }
  return facts;
}

}  // namespace sterna::volmesh::test_ends
