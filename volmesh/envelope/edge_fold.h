// Limit of the fold angle of the envelope along an edge, on the side of the fluid: the fold must leave room for tetrahedra.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Corners of the two triangles at an edge: start and end of the edge, third corner of the triangle in which the edge has this direction, third corner of the
/// other triangle.
using FoldPoints = std::array<Point, 4>;

/// Limits of the angle between the two triangles of the envelope, seen from the fluid (180 degrees where they are coplanar).
struct FoldLimit {
  double cos_least = k_usual_cos_least;  ///< cosine of the least angle
  double range = k_usual_range;          ///< difference of the cosine between the least angle and the angle below which the barrier begins
  bool is_concave = false;               ///< the wall's triangles rise from each other: the envelope's triangles must not swap sides

  static constexpr double k_least_angle = 0.2618;  ///< 15 degrees: a tetrahedron in the fold has no larger angle
  static constexpr double k_onset_angle = 0.6981;  ///< 40 degrees
  static constexpr double k_usual_cos_least = 0.9659258262890683, k_usual_cos_onset = 0.766044443118978;
  static constexpr double k_usual_range = k_usual_cos_least - k_usual_cos_onset;
  static constexpr double k_share_of_wall = 0.5;  ///< share of the wall's angle, if this angle is less than twice the least one
};

/// Cosine of the angle between the triangles, and whether they rise from each other.
struct Fold {
  Vec3 n1, n2;  ///< normals, with the length of the triangles' doubled areas
  double length1 = 0.0, length2 = 0.0;
  double cosine = 1.0;  ///< cosine between the normals: -1 where the triangles are folded onto each other
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

/// Returns the distance from the least angle, 1 where the barrier begins and beyond; not above 0 where the fold is too sharp.
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
