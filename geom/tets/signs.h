// Predicates with cheap filters for the usual case of clear answers; undecided cases are passed to the exact predicates.
#pragma once

#include <algorithm>
#include <cmath>

#include "geom/math/insphere.h"
#include "geom/math/predicates.h"

namespace sterna::tets {

/// Returns the sign of orient3d.
inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  // The determinant has six terms of at most x y z, each with 8 roundings (rule at exact::Bounded). 9 * 6 * 2^-53 covers them and the rounding of the bound.
  constexpr double k_bound = 6.1e-15;
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  const double x = std::max({std::abs(ab.x), std::abs(ac.x), std::abs(ad.x)});
  const double y = std::max({std::abs(ab.y), std::abs(ac.y), std::abs(ad.y)});
  const double z = std::max({std::abs(ab.z), std::abs(ac.z), std::abs(ad.z)});
  const double bound = k_bound * x * y * z, value = dot(cross(ab, ac), ad);
  if (value > bound) return 1;
  if (value < -bound) return -1;
  return orient3d(a, b, c, d);
}

/// Returns the sign of insphere.
inline int sphere_side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  // The determinant has 4 * 6 terms of at most 3 m^2 x y z, each with 17 roundings; the bound is 72 * 18 * 2^-53.
  constexpr double k_bound = 1.46e-13;
  const Vec3 pa = a - e, pb = b - e, pc = c - e, pd = d - e;
  const double x = std::max(std::max(std::abs(pa.x), std::abs(pb.x)), std::max(std::abs(pc.x), std::abs(pd.x)));
  const double y = std::max(std::max(std::abs(pa.y), std::abs(pb.y)), std::max(std::abs(pc.y), std::abs(pd.y)));
  const double z = std::max(std::max(std::abs(pa.z), std::abs(pb.z)), std::max(std::abs(pc.z), std::abs(pd.z)));
  const double m = std::max({x, y, z});
  const Vec3 ab = cross(pa, pb), cd = cross(pc, pd);
  const double value = (norm2(pa) * dot(cd, pb) - norm2(pb) * dot(cd, pa)) + (norm2(pc) * dot(ab, pd) - norm2(pd) * dot(ab, pc));
  const double bound = k_bound * m * m * x * y * z;
  if (value > bound) return 1;
  if (value < -bound) return -1;
  return insphere(a, b, c, d, e);
}

}  // namespace sterna::tets
