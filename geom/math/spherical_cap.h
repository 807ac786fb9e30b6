// The smallest cap of the unit sphere that contains given unit vectors. Its axis is the direction with the smallest maximum angle to all of them.
#pragma once

#include <span>

#include "geom/base/vec3.h"

namespace sterna {

struct SphericalCap {
  Vec3 axis;           ///< unit
  double angle = 0.0;  ///< radians, largest angle between the axis and a vector
};

/// Computes the cap incrementally (Welzl 1991, on the sphere); exact to rounding for vectors within a hemisphere. Beyond a hemisphere the angle is still
/// correct for the returned axis.
/// \pre not empty, unit vectors
SphericalCap smallest_spherical_cap(std::span<const Vec3> vectors);

}  // namespace sterna
