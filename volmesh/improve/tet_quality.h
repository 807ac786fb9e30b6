// How far a tetrahedron's dihedral angles are from the limits: one number that improvement raises, and what it costs to fall short of the limits.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geom/base/vec3.h"
#include "geom/mesh/computed_volumes.h"
#include "geom/mesh/gates.h"

namespace sterna::volmesh {

/// Limits that an improved tetrahedron keeps to, as one threshold on tet_quality().
struct QualityLimits {
  double target = 0.0;         ///< tetrahedra below are worked on
  double obtuse_weight = 1.0;  ///< of tet_quality(), such that both angle limits give the target
  double floor = 0.0;          ///< a change may make tetrahedra with angles as bad as this, or as the worst that it removes
  int max_failures = 255;      ///< tetrahedra are given up after so many tries, if not before
  /// Volumes may be so many times larger or smaller than those around (size_weight()); beyond it, quality is below the target, too.
  double size_step = std::numeric_limits<double>::infinity();
  double hard = 0.0;  ///< every tetrahedron beyond the hard limits of gate G14 is below, none that is within the target
};
/// \p min_angle, \p max_angle of a dihedral, radians.
inline QualityLimits quality_limits(double min_angle, double max_angle) {
  const double target = std::sin(min_angle), weight = target / std::sin(max_angle);
  const GateTable gates;
  const double hard_acute = std::sin(gates[Measure::min_dihedral].hard), hard_obtuse = weight * std::sin(gates[Measure::max_dihedral].hard);
  return {.target = target, .obtuse_weight = weight, .hard = std::min(target, std::max(hard_acute, hard_obtuse))};
}

/// Tetrahedra of a lower quality are flat: their angles alone make them the worst of a mesh.
inline constexpr double k_flat_quality = 1e-6;

/// What the angles of a tetrahedron say of it.
struct TetShape {
  double quality = -1.0;     ///< see tet_shape()
  double six_volumes = 0.0;  ///< m^3
};
/// Smallest sine of the six dihedral angles, those of obtuse angles times `obtuse_weight` (Klingner and Shewchuk 2007), in (0, 1]; -1 for a tetrahedron that is
/// not positive. A volume that is within rounding in double precision (k_solver_margin) limits it, too, where the angles do not. 0.05 us.
inline TetShape tet_shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double obtuse_weight) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  // Twice the faces' area vectors, inwards; face k is opposite corner k. |n_i x n_j| = 6 V times the length of the edge that faces i and j share.
  const Vec3 n3 = cross(ab, ac), n2 = cross(ad, ab), n1 = cross(ac, ad);
  const Vec3 n0 = -(n1 + n2 + n3);
  const double det = dot(n3, ad);
  if (!(det > 0.0)) return {};
  const std::array<Vec3, 4> n = {n0, n1, n2, n3};
  const std::array<double, 4> inverse = {1.0 / norm2(n0), 1.0 / norm2(n1), 1.0 / norm2(n2), 1.0 / norm2(n3)};
  const double weight = obtuse_weight * obtuse_weight;
  const auto squared = [&](std::size_t i, std::size_t j, const Vec3& edge) {
    return norm2(edge) * inverse[i] * inverse[j] * (dot(n[i], n[j]) > 0.0 ? weight : 1.0);
  };
  const Vec3 bc = c - b, bd = d - b, cd = d - c;
  const double smallest = std::min({squared(2, 3, ab), squared(1, 3, ac), squared(1, 2, ad), squared(0, 3, bc), squared(0, 2, bd), squared(0, 1, cd)});
  const double quality = std::min(1.0, det * std::sqrt(smallest));
  // The largest product of three edges at a corner, squared.
  const double l_ab = norm2(ab), l_ac = norm2(ac), l_ad = norm2(ad), l_bc = norm2(bc), l_bd = norm2(bd), l_cd = norm2(cd);
  const double edges = std::max({l_ab * l_ac * l_ad, l_ab * l_bc * l_bd, l_ac * l_bc * l_cd, l_ad * l_bd * l_cd});
  // Flat ones are the worst as they are.
  if (quality < k_flat_quality || det * det > k_solver_margin * k_solver_margin * edges) return {quality, det};
  return {std::min(quality, det / std::sqrt(edges)), det};
}
inline double tet_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double obtuse_weight) {
  return tet_shape(a, b, c, d, obtuse_weight).quality;
}

/// Of a vertex around which tetrahedra have such volumes, as the mean of their logarithms: six volumes of a tetrahedron times the weights of its vertices are
/// its volume over the geometric mean of theirs.
inline double size_weight(double mean_log_of_six_volumes) { return std::exp(-0.25 * mean_log_of_six_volumes); }
/// The quality of a shape among such sizes (product of the weights of its vertices). A step of volumes beyond the limit is as bad as an angle beyond its limit,
/// and falls with the fourth root only, which keeps it among the qualities that angles have.
inline double quality_among(const TetShape& shape, double weights, const QualityLimits& limits) {
  const double ratio = shape.six_volumes * weights, step = std::max(ratio, 1.0 / ratio);
  return shape.quality <= 0.0 || step <= limits.size_step ? shape.quality
                                                          : std::min(shape.quality, limits.target * std::sqrt(std::sqrt(limits.size_step / step)));
}

/// Cosines of the smallest and of the largest dihedral angle.
/// \pre positive tetrahedron.
inline std::array<double, 2> dihedral_cosines(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  const Vec3 n3 = cross(ab, ac), n2 = cross(ad, ab), n1 = cross(ac, ad);
  const Vec3 n0 = -(n1 + n2 + n3);
  const Vec3 u0 = normalized(n0), u1 = normalized(n1), u2 = normalized(n2), u3 = normalized(n3);
  // Two inward normals enclose the supplement of the angle.
  const auto [low, high] = std::minmax({-dot(u0, u1), -dot(u0, u2), -dot(u0, u3), -dot(u1, u2), -dot(u1, u3), -dot(u2, u3)});
  return {std::min(high, 1.0), std::max(low, -1.0)};
}

}  // namespace sterna::volmesh
