// Places along Hilbert's curve in space: what is near on the curve is near in space.
#pragma once

#include <cstdint>
#include <span>

#include "geom/base/vec3.h"

namespace sterna::tets {

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
