// Places along Hilbert's curve in space: what is near on the curve is near in space.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "geom/base/vec3.h"

namespace sterna::tets {

/// Corners of the box around some points; infinite, the low one above the high one, where there are none.
struct Extent {
  Vec3 low, high;
  double longest_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};
Extent extent_of(std::span<const Vec3> points);

/// A cube cut into 2^63 cells, numbered along the curve.
class Curve {
 public:
  /// Around these points. \pre finite
  explicit Curve(std::span<const Vec3> points);
  /// Of the cell that a point lies in; of a point outside of the cube the nearest cell's.
  std::uint64_t key(const Vec3& p) const;

 private:
  Vec3 origin_;
  double cells_per_metre_ = 0.0;
};

}  // namespace sterna::tets
