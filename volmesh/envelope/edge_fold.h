// Limit for the fold angle of the envelope along an edge, on the side of the fluid. The fold must leave room for tetrahedra.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Corners of the two triangles at an edge: start and end of the edge, third corner of the triangle that contains the edge in this direction, third corner of
/// the other triangle.
using FoldPoints = std::array<Point, 4>;

/// Limits of the angle between the two triangles of the envelope, as seen from the fluid (180 degrees if they are coplanar).
struct FoldLimit {
  double cos_least = k_usual_cos_least;  ///< cosine of the smallest allowed angle
  double range = k_usual_range;          ///< difference between the cosines of the smallest allowed angle and of the angle below which the barrier begins
  bool is_concave = false;               ///< the triangles of the wall rise from each other, so the envelope's triangles must not swap sides

  static constexpr double k_least_angle = 0.2618;  ///< 15 degrees: a tetrahedron in the fold has no larger dihedral angle
  static constexpr double k_onset_angle = 0.6981;  ///< 40 degrees: the barrier begins below this angle
  static constexpr double k_usual_cos_least = 0.9659258262890683, k_usual_cos_onset = 0.766044443118978;
  static constexpr double k_usual_range = k_usual_cos_least - k_usual_cos_onset;
  static constexpr double k_share_of_wall = 0.5;  ///< fraction of the wall's angle that is kept, if that angle is less than twice the smallest allowed one
};

/// Cosine of the angle between the triangles, and whether the triangles rise from each other.
struct Fold {
  Vec3 n1, n2;  ///< normals; their lengths are twice the areas of the triangles
  double length1 = 0.0, length2 = 0.0;
  double cosine = 1.0;  ///< cosine between the normals; -1 if the triangles are folded onto each other
  bool is_concave = false;
};
inline Fold fold_of(const FoldPoints& p) {
  Fold f;
  const Vec3 e = p[1] - p[0], out = p[3] - p[0];
  f.n1 = cross(e, p[2] - p[0]);
  f.n2 = cross(out, e);
  f.length1 = norm(f.n1);
  f.length2 = norm(f.n2);
  f.cosine = dot(f.n1, f.n2) / (f.length1 * f.length2);
  f.is_concave = dot(f.n1, out) > 0.0;
  return f;
}

/// Returns the fold limit for the edge of the envelope over this edge of the wall.
inline FoldLimit fold_limit(const FoldPoints& wall) {
  FoldLimit limit;
  const Fold fold = fold_of(wall);
  limit.is_concave = fold.is_concave;
  if (!fold.is_concave || fold.cosine > -FoldLimit::k_usual_cos_onset) return limit;
  const double angle = std::acos(std::min(1.0, -fold.cosine));
  limit.cos_least = std::cos(std::min(FoldLimit::k_least_angle, FoldLimit::k_share_of_wall * angle));
  limit.range = limit.cos_least + fold.cosine;
  return limit;
}

/// Returns a measure of the distance from the smallest allowed angle. It is 1 if the angle is at least that at which the barrier begins, and zero or negative
/// if the fold is too sharp.
inline double fold_slack(const Fold& fold, const FoldLimit& limit) {
  if (fold.cosine > -0.5) return 1.0;
  if (!fold.is_concave) return limit.is_concave && fold.cosine < -FoldLimit::k_usual_cos_onset ? -1.0 : 1.0;
  return std::min(1.0, (fold.cosine + limit.cos_least) / limit.range);
}

/// Returns the derivatives of the fold's cosine with respect to the four points.
inline std::array<Vec3, 4> fold_gradient(const FoldPoints& p, const Fold& f) {
  const Vec3 u1 = f.n1 / f.length1, u2 = f.n2 / f.length2;
  const Vec3 g1 = (u2 - f.cosine * u1) / f.length1, g2 = (u1 - f.cosine * u2) / f.length2;
  const Vec3 e = p[1] - p[0], first = p[2] - p[0], out = p[3] - p[0];
  std::array<Vec3, 4> d;
  d[1] = cross(first, g1) + cross(g2, out);
  d[2] = cross(g1, e);
  d[3] = cross(e, g2);
  d[0] = -(d[1] + d[2] + d[3]);
  return d;
}

}  // namespace sterna::volmesh
