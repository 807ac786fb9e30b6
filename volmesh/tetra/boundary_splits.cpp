#include "volmesh/tetra/boundary_splits.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "geom/base/error.h"
#include "volmesh/tetra/boundary_check.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Weights = std::array<double, 3>;

/// Tolerance for the sum of the relative areas of a triangle's parts, which is 1 except for rounding. There are at most thousands of parts.
constexpr double k_area_tolerance = 1e-9;
/// A weight nearer to 0 than this counts as zero: the point is on an edge or corner, because it has no triangles of positive area on both sides.
constexpr double k_least_weight = 1e-12;

class Finder {
 public:
  Finder(const TetraBoundary& boundary, std::span<const Vec3> points) : boundary_(boundary), points_(points), n_old_(boundary.points.size()) {}

  BoundarySplits find(std::span<const Triangle> triangles, std::span<const std::uint32_t> parents) {
    std::vector<std::size_t> order(triangles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return parents[i]; });
    for (const std::size_t i : order) {
      if (parents[i] >= boundary_.triangles.size())
        throw_invalid("a face belongs to boundary triangle " + std::to_string(parents[i]) + " of " + std::to_string(boundary_.triangles.size()));
      splits_.triangles.push_back(triangles[i]);
      splits_.parents.push_back(parents[i]);
    }
    splits_.points.assign(points_.begin() + static_cast<std::ptrdiff_t>(n_old_), points_.end());
    find_origins();
    for (std::size_t begin = 0, t = 0; t < boundary_.triangles.size(); ++t) {
      std::size_t end = begin;
      while (end < splits_.parents.size() && splits_.parents[end] == t) ++end;
      tile(static_cast<std::uint32_t>(t), begin, end);
      begin = end;
    }
    return std::move(splits_);
  }

 private:
  [[noreturn]] void throw_invalid(std::string problem, std::optional<std::uint32_t> triangle = std::nullopt) const {
    ErrorInfo error{.code = ErrorCode::tetra_result_invalid, .attempted = "reading the boundary splits of the engine", .problem = std::move(problem)};
    if (triangle) error.locations.push_back(location_of_triangle(boundary_, *triangle, ""));
    throw Error(std::move(error));
  }

  /// Finds the origin of each point. A point that two triangles use lies on their common edge. A point of a single triangle lies inside the triangle.
  void find_origins() {
    constexpr std::uint32_t k_none = ~std::uint32_t{0};
    std::vector<std::array<std::uint32_t, 2>> users(splits_.points.size(), {k_none, k_none});
    for (std::size_t i = 0; i < splits_.triangles.size(); ++i) {
      const std::uint32_t parent = splits_.parents[i];
      for (const std::uint32_t v : splits_.triangles[i]) {
        if (v >= points_.size()) throw_invalid("a face of the boundary has a point that does not exist", parent);
        if (v < n_old_) continue;
        auto& [first, second] = users[v - n_old_];
        if (first == k_none || first == parent) first = parent;
        else if (second == k_none || second == parent) second = parent;
        else throw_invalid("a new point lies in three triangles of the boundary", parent);
      }
    }
    splits_.origins.resize(splits_.points.size());
    for (std::size_t i = 0; i < users.size(); ++i) {
      const auto [first, second] = users[i];
      if (first == k_none) throw_invalid("a new point of the boundary has no triangle");
      splits_.origins[i] = {first, second == k_none ? weights_inside(first, splits_.points[i]) : weights_on_edge(first, second, splits_.points[i])};
    }
  }

  Weights weights_on_edge(std::uint32_t triangle, std::uint32_t other, const Vec3& p) const {
    const Triangle &a = boundary_.triangles[triangle], &b = boundary_.triangles[other];
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::ranges::count(b, a[k]) == 0 || std::ranges::count(b, a[(k + 1) % 3]) == 0) continue;
      const Vec3 &from = boundary_.points[a[k]], edge = boundary_.points[a[(k + 1) % 3]] - from;
      const double share = dot(p - from, edge) / norm2(edge);
      if (!(share > k_least_weight && share < 1.0 - k_least_weight)) throw_invalid("a new point lies outside of the edge that it splits", triangle);
      Weights weights{};
      weights[k] = 1.0 - share;
      weights[(k + 1) % 3] = share;
      return weights;
    }
    throw_invalid("a new point lies in two triangles without a common edge", triangle);
  }

  Weights weights_inside(std::uint32_t triangle, const Vec3& p) const {
    const Triangle& t = boundary_.triangles[triangle];
    const Vec3 &a = boundary_.points[t[0]], &b = boundary_.points[t[1]], &c = boundary_.points[t[2]];
    const Vec3 n = cross(b - a, c - a);
    Weights weights = {dot(cross(c - b, p - b), n), dot(cross(a - c, p - c), n), dot(cross(b - a, p - a), n)};
    const double sum = weights[0] + weights[1] + weights[2];
    for (double& w : weights) {
      w /= sum;
      if (!(w > k_least_weight)) throw_invalid("a new point lies outside of the triangle that it splits", triangle);
    }
    return weights;
  }

  /// Returns the barycentric coordinates of a node in a triangle. The node is a corner of the triangle, lies on one of its edges, or inside it.
  Weights weights_in(std::uint32_t triangle, std::uint32_t node) const {
    const Triangle& t = boundary_.triangles[triangle];
    Weights weights{};
    if (node < n_old_) {
      const auto k = static_cast<std::size_t>(std::ranges::find(t, node) - t.begin());
      if (k == 3) throw_invalid("a part of a boundary triangle has a corner of another boundary triangle", triangle);
      weights[k] = 1.0;
      return weights;
    }
    const BoundarySplits::Origin& origin = splits_.origins[node - n_old_];
    if (origin.triangle == triangle) return origin.weights;
    for (std::size_t k = 0; k < 3; ++k) {  // the node is on a common edge, as found by find_origins()
      const auto at = static_cast<std::size_t>(std::ranges::find(t, boundary_.triangles[origin.triangle][k]) - t.begin());
      if (at < 3) weights[at] = origin.weights[k];
    }
    return weights;
  }

  /// Checks and orients the parts [begin, end) of a triangle.
  void tile(std::uint32_t triangle, std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      Triangle& part = splits_.triangles[i];
      const Weights a = weights_in(triangle, part[0]), b = weights_in(triangle, part[1]), c = weights_in(triangle, part[2]);
      const double area = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
      if (area == 0.0) throw_invalid("a part of a boundary triangle has no area", triangle);
      if (area < 0.0) std::swap(part[1], part[2]);
      sum += std::abs(area);
    }
    if (std::abs(sum - 1.0) > k_area_tolerance) throw_invalid("the parts of a boundary triangle cover " + std::to_string(sum) + " times its area", triangle);
  }

  const TetraBoundary& boundary_;
  std::span<const Vec3> points_;
  std::size_t n_old_;
  BoundarySplits splits_;
};

}  // namespace

BoundarySplits find_splits(const TetraBoundary& boundary, std::span<const Vec3> points, std::span<const Triangle> triangles,
                           std::span<const std::uint32_t> parents) {
  return Finder(boundary, points).find(triangles, parents);
}

}  // namespace sterna::volmesh
