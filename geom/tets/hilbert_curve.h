// Positions along a Hilbert curve in space: points close on the curve are close in space.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "geom/base/vec3.h"

namespace sterna::tets {

/// Corners of the bounding box of points; infinite, low above high, if there are no points.
struct Extent {
  Vec3 low, high;
  double longest_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};
Extent extent_of(std::span<const Vec3> points);

/// A cube cut into 2^63 cells, numbered along the curve.
class Curve {
 public:
  /// Constructs the cube around these points. \pre finite
  explicit Curve(std::span<const Vec3> points);
  /// Returns the key of the cell that contains a point; for a point outside the cube, that of the nearest cell.
  std::uint64_t key(const Vec3& p) const;

 private:
  Vec3 origin_;
  double cells_per_metre_ = 0.0;
};

}  // namespace sterna::tets
