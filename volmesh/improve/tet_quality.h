// Distance of a tetrahedron's dihedral angles from the limits: one quality number that improvement increases, and the limits on it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geom/base/vec3.h"
#include "geom/mesh/computed_volumes.h"
#include "geom/mesh/gates.h"

namespace sterna::volmesh {

/// Limits for improved tetrahedra, as one threshold on tet_quality().
struct QualityLimits {
  double target = 0.0;         ///< tetrahedra below are improved
  double obtuse_weight = 1.0;  ///< weight in tet_quality(), such that both angle limits give the target
  double floor = 0.0;          ///< a change may make tetrahedra with angles as bad as this, or as the worst that it removes
  int max_failures = 255;      ///< tetrahedra are given up after this many attempts, if not before
  /// Largest ratio, in either direction, of a volume to those around it (size_weight()); beyond it, quality is below the target, too.
  double size_step = std::numeric_limits<double>::infinity();
  double hard = 0.0;  ///< threshold between the hard limits of gate G14 and the target: every tetrahedron beyond the hard limits is below, no tetrahedron
                      ///< within the target is
};
/// Returns the limits. \p min_angle, \p max_angle of a dihedral, radians.
inline QualityLimits quality_limits(double min_angle, double max_angle) {
  const double target = std::sin(min_angle), weight = target / std::sin(max_angle);
  const GateTable gates;
  const double hard_acute = std::sin(gates[Measure::min_dihedral].hard), hard_obtuse = weight * std::sin(gates[Measure::max_dihedral].hard);
  return {.target = target, .obtuse_weight = weight, .hard = std::min(target, std::max(hard_acute, hard_obtuse))};
}

/// Tetrahedra of a lower quality are flat: their angles alone make them the worst of a mesh.
inline constexpr double k_flat_quality = 1e-6;

/// Quality of a tetrahedron's angles, and its volume.
struct TetShape {
  double quality = -1.0;     ///< see tet_shape()
  double six_volumes = 0.0;  ///< m^3
};
/// Computes the smallest sine of the six dihedral angles, with those of obtuse angles times `obtuse_weight` (Klingner and Shewchuk 2007), in (0, 1]; -1 for a
/// tetrahedron that is not positive. A volume that is within rounding in double precision (k_solver_margin) also limits the quality, where the angles do not.
/// 0.05 us.
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
  // Flat tetrahedra are already the worst.
  if (quality < k_flat_quality || det * det > k_solver_margin * k_solver_margin * edges) return {quality, det};
  return {std::min(quality, det / std::sqrt(edges)), det};
}
inline double tet_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double obtuse_weight) {
  return tet_shape(a, b, c, d, obtuse_weight).quality;
}

/// Size weight of a vertex, from the mean of the logarithms of the surrounding volumes: six times the volume of a tetrahedron, times the weights of its
/// vertices, is its volume over the geometric mean of the volumes at these vertices.
inline double size_weight(double mean_log_of_six_volumes) { return std::exp(-0.25 * mean_log_of_six_volumes); }
/// Quality of a shape among given sizes (product of the weights of its vertices). A volume ratio beyond the limit is as bad as an angle beyond its limit. It
/// reduces the quality with the fourth root only, which keeps it in the range of the angle qualities.
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
