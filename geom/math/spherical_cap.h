// The smallest cap of the unit sphere that holds given unit vectors: its axis is the direction that sees all of them best.
#pragma once

#include <span>

#include "geom/base/vec3.h"

namespace sterna {

struct SphericalCap {
  Vec3 axis;           ///< unit
  double angle = 0.0;  ///< radians, largest angle between the axis and a vector
};

/// Incremental (Welzl 1991, on the sphere); exact to rounding for vectors within a hemisphere. Beyond that the angle is still the true one of the returned
/// axis.
/// \pre not empty, unit vectors
SphericalCap smallest_spherical_cap(std::span<const Vec3> vectors);

}  // namespace sterna
