// Distance of a tetrahedron's dihedral angles from the limits, as a single quality number that the improvement increases, and the limits for it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geom/base/vec3.h"
#include "geom/mesh/computed_volumes.h"
#include "geom/mesh/gates.h"

namespace sterna::volmesh {

/// Limits for improved tetrahedra, as thresholds for tet_quality().
struct QualityLimits {
  double target = 0.0;         ///< tetrahedra of lower quality are improved
  double obtuse_weight = 1.0;  ///< weight of obtuse angles in tet_quality(), such that both angle limits give the same target
  double floor = 0.0;          ///< a change may make tetrahedra of this quality, or of the quality of the worst that it removes
  int max_failures = 255;      ///< largest number of attempts for a tetrahedron
  /// Largest ratio, in either direction, of a volume to those around it (size_weight()). With a larger ratio, the quality is below the target, too.
  double size_step = std::numeric_limits<double>::infinity();
  double hard = 0.0;  ///< threshold between the hard limits of gate G14 and the target: every tetrahedron beyond the hard limits is below it, and no
                      ///< tetrahedron within the target is
};
/// Returns the limits. \p min_angle and \p max_angle are limits for dihedral angles, radians.
inline QualityLimits quality_limits(double min_angle, double max_angle) {
  const double target = std::sin(min_angle), weight = target / std::sin(max_angle);
  const GateTable gates;
  const double hard_acute = std::sin(gates[Measure::min_dihedral].hard), hard_obtuse = weight * std::sin(gates[Measure::max_dihedral].hard);
  return {.target = target, .obtuse_weight = weight, .hard = std::min(target, std::max(hard_acute, hard_obtuse))};
}

/// Tetrahedra of a lower quality are flat. Their angles alone make them the worst of a mesh.
inline constexpr double k_flat_quality = 1e-6;

/// Quality of a tetrahedron's angles, and its volume.
struct TetShape {
  double quality = -1.0;     ///< quality as defined at tet_shape()
  double six_volumes = 0.0;  ///< m^3, six times the volume
};
/// Computes the quality: the smallest sine of the six dihedral angles, in (0, 1]. Sines of obtuse angles are multiplied by `obtuse_weight` (Klingner and
/// Shewchuk 2007). The quality is -1 for a tetrahedron that is not positive. If the volume is within rounding in double precision (k_solver_margin) but the
/// angles are not small, the volume limits the quality. 0.05 us.
inline TetShape tet_shape(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double obtuse_weight) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  // Face normals with twice the areas of the faces, inwards; face k is opposite corner k. |n_i x n_j| = 6 V times the length of the edge that faces i and j
  // share.
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
  // Squared: the largest product of the three edges at a corner.
  const double l_ab = norm2(ab), l_ac = norm2(ac), l_ad = norm2(ad), l_bc = norm2(bc), l_bd = norm2(bd), l_cd = norm2(cd);
  const double edges = std::max({l_ab * l_ac * l_ad, l_ab * l_bc * l_bd, l_ac * l_bc * l_cd, l_ad * l_bd * l_cd});
  // Flat tetrahedra are the worst in any case.
  if (quality < k_flat_quality || det * det > k_solver_margin * k_solver_margin * edges) return {quality, det};
  return {std::min(quality, det / std::sqrt(edges)), det};
}
inline double tet_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double obtuse_weight) {
  return tet_shape(a, b, c, d, obtuse_weight).quality;
}

/// Returns the size weight of a vertex, from the mean of the logarithms of the surrounding volumes. Six times the volume of a tetrahedron, multiplied by the
/// weights of its vertices, is the ratio of its volume to the geometric mean of the volumes at these vertices.
inline double size_weight(double mean_log_of_six_volumes) { return std::exp(-0.25 * mean_log_of_six_volumes); }
/// Returns the quality of a shape for given sizes. \p weights is the product of the weights of its vertices. A volume ratio beyond the limit is as bad as an
/// angle beyond its limit. It reduces the quality only with the fourth root, which keeps it in the range of the angle qualities.
inline double quality_among(const TetShape& shape, double weights, const QualityLimits& limits) {
  const double ratio = shape.six_volumes * weights, step = std::max(ratio, 1.0 / ratio);
  return shape.quality <= 0.0 || step <= limits.size_step ? shape.quality
                                                          : std::min(shape.quality, limits.target * std::sqrt(std::sqrt(limits.size_step / step)));
}

/// Returns the cosines of the smallest and of the largest dihedral angle.
/// \pre the tetrahedron is positive
inline std::array<double, 2> dihedral_cosines(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  const Vec3 n3 = cross(ab, ac), n2 = cross(ad, ab), n1 = cross(ac, ad);
  const Vec3 n0 = -(n1 + n2 + n3);
  const Vec3 u0 = normalized(n0), u1 = normalized(n1), u2 = normalized(n2), u3 = normalized(n3);
  // The angle between two inward normals is the supplement of the dihedral angle.
  const auto [low, high] = std::minmax({-dot(u0, u1), -dot(u0, u2), -dot(u0, u3), -dot(u1, u2), -dot(u1, u3), -dot(u2, u3)});
  return {std::min(high, 1.0), std::max(low, -1.0)};
}

}  // namespace sterna::volmesh
