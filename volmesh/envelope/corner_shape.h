// How pointed the corners of an envelope triangle may be, by those of its wall triangle: no stage makes a needle that the wall has not.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Least sine of a corner of an envelope triangle (12 degrees), unless the wall's own is about as small. Tetrahedra over a corner of alpha have a dihedral
/// angle or a volume step that follows it; at 15 degrees wing_body loses four points of normal coverage.
inline constexpr double k_least_corner_sine = 0.2079;
/// Of the sine of the wall triangle's corner that is kept where this is less.
inline constexpr double k_corner_share_of_wall = 0.5;

/// Sines of the corners at the start of a, at its end and at that of b, for a triangle of the edges a and b from one corner. \p area2: |a x b|, twice its area.
inline std::array<double, 3> corner_sines(const Vec3& a, const Vec3& b, double area2) {
  const double la = norm(a), lb = norm(b), lc = norm(b - a);
  return {area2 / (la * lb), area2 / (la * lc), area2 / (lb * lc)};
}

/// Least sine of the envelope's corner over a corner of the wall.
inline double least_corner_sine(double wall_sine) { return std::min(k_least_corner_sine, k_corner_share_of_wall * wall_sine); }

}  // namespace sterna::volmesh
