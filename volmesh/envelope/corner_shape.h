// Smallest corner angles of an envelope triangle, relative to its wall triangle. They prevent sliver triangles where the wall has none.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Smallest sine of a corner of an envelope triangle (12 degrees), unless the corner of the wall triangle is about as small. Tetrahedra over a corner of alpha
/// have a dihedral angle or a volume step of the same order. With 15 degrees, wing_body loses four percentage points of normal coverage.
inline constexpr double k_least_corner_sine = 0.2079;
/// Fraction of the sine of the wall triangle's corner that is kept, if that is less than k_least_corner_sine.
inline constexpr double k_corner_share_of_wall = 0.5;

/// Returns the sines of the corners at the start of a, at the end of a and at the end of b, for the triangle of the edges a and b from one corner. \p area2 is
/// |a x b|, twice its area.
inline std::array<double, 3> corner_sines(const Vec3& a, const Vec3& b, double area2) {
  const double la = norm(a), lb = norm(b), lc = norm(b - a);
  return {area2 / (la * lb), area2 / (la * lc), area2 / (lb * lc)};
}

/// Returns the smallest allowed sine of the envelope's corner over a corner of the wall.
inline double least_corner_sine(double wall_sine) { return std::min(k_least_corner_sine, k_corner_share_of_wall * wall_sine); }

}  // namespace sterna::volmesh
