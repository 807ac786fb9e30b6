// Edge lengths that grow with the distance from places that know theirs.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

struct SizePlace {
  Point point;
  double size = 0.0;  ///< metres
};

/// h(x) = min over the places of (size + slope * distance), in a tree of boxes that know their smallest size. Reading it is thread-safe, about half a
/// microsecond.
class LoopSizes {
 public:
  /// \pre places finite, sizes positive, slope > 0
  LoopSizes(std::vector<SizePlace> places, double slope);
  /// At most k_tolerance above the minimum; infinite without places.
  double operator()(const Point& p) const;

  /// Boxes that could lower the value by less than this part of it are not opened: at the centre of a circle all its points are as near.
  static constexpr double k_tolerance = 0.02;

 private:
  struct Node {
    Box box;
    double least = std::numeric_limits<double>::infinity();  ///< size in the box
    std::uint32_t first = 0;                                 ///< leaf: first place; inner: left child, the right one follows it
    std::uint32_t count = 0;                                 ///< leaf: number of places; inner: 0
  };
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  double bound(const Node& node, const Point& p) const;

  std::vector<SizePlace> places_;
  std::vector<Node> nodes_;
  double slope_;
};

}  // namespace sterna::volmesh
