#include "volmesh/adjacent/copy_translated.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "geom/base/number_text.h"
#include "volmesh/adjacent/adjacent_chart.h"
#include "volmesh/adjacent/adjacent_errors.h"
#include "volmesh/adjacent/adjacent_part.h"

namespace sterna::volmesh {
namespace {

std::vector<std::uint32_t> loop_indices(const AdjacentRegion& region) {
  std::vector<std::uint32_t> points;
  for (const AdjacentEdge& edge : region.edges) points.insert(points.end(), edge.begin(), edge.end());
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// Points of the partner, sorted by a key and searched within a tolerance.
class Partners {
 public:
  Partners(const AdjacentRegion& to, double tolerance) : to_(to), tolerance_(tolerance), order_(loop_indices(to)) {
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t i, std::uint32_t j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
  }
  /// Returns the nearest point; k_none if no point is within the tolerance.
  std::uint32_t find(const Point& p) const {
    std::uint32_t best = k_none;
    double least = tolerance_;
    const double along = key(p);
    // The bound is valid because |key(p) - key(q)| is at most sqrt(3) times the distance.
    auto at = std::lower_bound(order_.begin(), order_.end(), along - 2.0 * tolerance_, [&](std::uint32_t i, double x) { return key(i) < x; });
    for (; at != order_.end() && key(*at) <= along + 2.0 * tolerance_; ++at)
      if (const double d = distance(to_.points[*at], p); d <= least && (best == k_none || d < least)) {
        least = d;
        best = *at;
      }
    return best;
  }

  static constexpr std::uint32_t k_none = ~0u;

 private:
  /// Projection to a direction on which the points of sides along coordinate axes differ.
  static double key(const Point& p) { return p.x + 0.7 * p.y + 0.4 * p.z; }
  double key(std::uint32_t i) const { return key(to_.points[i]); }
  const AdjacentRegion& to_;
  double tolerance_;
  std::vector<std::uint32_t> order_;
};

/// Returns 1 if the edges of both regions have the same direction, -1 if they have opposite directions. \throws Error if the edges are different
int sense_of(const AdjacentRegion& from, const AdjacentRegion& to, const std::vector<std::uint32_t>& partner) {
  std::vector<AdjacentEdge> edges(to.edges), same, opposite;
  std::sort(edges.begin(), edges.end());
  for (const AdjacentEdge& edge : from.edges) {
    same.push_back({partner[edge[0]], partner[edge[1]]});
    opposite.push_back({partner[edge[1]], partner[edge[0]]});
  }
  std::sort(same.begin(), same.end());
  std::sort(opposite.begin(), opposite.end());
  if (same == edges) return 1;
  if (opposite == edges) return -1;
  ErrorInfo info = adjacent_error(to, ErrorCode::bad_argument,
                                  "the loop edges differ from the edges of the periodic partner \"" + from.name + "\", in both senses of rotation");
  const auto note = [&](const std::vector<AdjacentEdge>& a, const std::vector<AdjacentEdge>& b, const char* what) {
    std::vector<AdjacentEdge> only;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only));
    for (const AdjacentEdge& edge : only) info.add_location(0.5 * (to.points[edge[0]] + to.points[edge[1]]), what);
  };
  std::vector<AdjacentEdge> common;
  std::set_intersection(opposite.begin(), opposite.end(), edges.begin(), edges.end(), std::back_inserter(common));
  const std::vector<AdjacentEdge>& moved = common.empty() ? same : opposite;
  note(moved, edges, "edge of the partner only");
  note(edges, moved, "edge of this patch only");
  throw Error(std::move(info));
}

}  // namespace

AdjacentTriangles copy_translated(const AdjacentRegion& from, const AdjacentTriangles& triangles, const AdjacentRegion& to, const Vec3& translation,
                                  double body_length) {
  const double tolerance = k_periodic_tolerance * body_length;
  const Partners partners(to, tolerance);
  std::vector<std::uint32_t> partner(from.points.size(), Partners::k_none);
  std::vector<std::uint8_t> is_taken(to.points.size(), 0);
  ErrorInfo info = adjacent_error(to, ErrorCode::bad_argument,
                                  "loops do not match the periodic partner \"" + from.name + "\" within " + in_metres(tolerance, k_adjacent_digits));
  for (const std::uint32_t i : loop_indices(from)) {
    partner[i] = partners.find(from.points[i] + translation);
    if (partner[i] == Partners::k_none) info.add_location(from.points[i] + translation, "point of the partner without a point of this patch");
    else if (is_taken[partner[i]]++ != 0) info.add_location(to.points[partner[i]], "two points of the partner match one point of this patch");
  }
  for (const std::uint32_t i : loop_indices(to))
    if (is_taken[i] == 0) info.add_location(to.points[i], "point of this patch without a point of the partner");
  info.hint = "give periodic sides the same layers and the same points along the adjacent patches";
  if (info.n_locations > 0) throw Error(std::move(info));
  const int sense = sense_of(from, to, partner);

  AdjacentTriangles result = triangles;
  result.worst_location += translation;
  for (Point& p : result.new_points) p += translation;
  if (const std::optional<AdjacentFrame> plane = plane_of(to))
    for (Point& p : result.new_points)
      for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(plane->normal[k]) == 1.0) p[k] = plane->origin[k];
  for (auto& triangle : result.triangles) {
    for (std::uint32_t& i : triangle) i = i < from.points.size() ? partner[i] : static_cast<std::uint32_t>(i - from.points.size() + to.points.size());
    if (sense < 0) std::swap(triangle[1], triangle[2]);
  }
  return result;
}

}  // namespace sterna::volmesh
