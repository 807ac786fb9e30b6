// Points with a size, and the smallest size that grows from any of them to a given location.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna {

/// A point and the target edge length there.
struct SizePoint {
  Point point;        ///< m
  double size = 0.0;  ///< m, positive
};

/// Hierarchy over size points that computes the minimum over all size points of (size + slope * distance), a nearest-neighbour search with additive weights.
/// Queries are thread-safe.
class SizePointTree {
 public:
  /// Builds the tree in parallel, O(n log n).
  /// \pre finite coordinates, positive sizes, slope > 0
  SizePointTree(std::span<const SizePoint> size_points, double slope, const RunContext& context);

  struct Search {
    double cap = std::numeric_limits<double>::infinity();  ///< m, the result if no size point gives less
    double reach = 0.0;                                    ///< m; sizes grow only beyond this distance; within it the smallest size counts
    /// Boxes are not opened if they could lower the value by less than this fraction. This saves time if many size points are equally near, as at the centre of
    /// a circle.
    double tolerance = 0.0;
  };
  /// Returns the minimum over all size points, exact to rounding except for the search's tolerance.
  double smallest(const Point& p, const Search& search) const;
  /// Returns the minimum without cap, reach and tolerance. \p hint: a size point to start from; it is set to the size point that gave the minimum. Any value
  /// below size() is correct, and a hint from a neighbouring point makes the search short. \pre size() > 0
  double smallest(const Point& p, std::uint32_t& hint) const;
  std::size_t size() const { return size_points_.size(); }

 private:
  struct Node {
    std::array<float, 3> min, max;  ///< rounded outwards
    float smallest;                 ///< smallest size in the subtree, rounded down
    std::uint32_t first;            ///< leaf: first size point; inner node: left child, which the right child follows
    std::uint32_t count;            ///< leaf: number of size points; inner node: 0
  };
  double lower_bound(const Node& node, const Point& p, double reach) const;
  /// Calls found(point, value) for each size point that lowers `best`.
  template <class Found>
  void lower(const Point& p, const Search& search, double& best, const Found& found) const;

  double slope_;
  std::vector<Node> nodes_;
  std::vector<SizePoint> size_points_;  ///< in the order of the leaves
};

}  // namespace sterna
