// Based on the fact that a vector outside the cap of its predecessors lies on the boundary of the new cap.
#include "geom/math/spherical_cap.h"

#include <algorithm>

namespace sterna {
namespace {

/// A vector this much (in cosine) outside a cap still counts as inside: far below any relevant angle, far above rounding.
constexpr double k_slack = 1e-12;

struct Rim {
  Vec3 axis;
  double cosine;
  bool is_outside(const Vec3& v) const { return dot(v, axis) < cosine - k_slack; }
};

Rim through(const Vec3& a, const Vec3& b) {
  const Vec3 axis = normalized(a + b);
  return {axis, dot(axis, a)};
}

/// Returns the cap through the three vectors, on their side; through two of them if they are nearly collinear on the sphere.
Rim through(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 axis = normalized(cross(b - a, c - a));
  if (norm2(axis) == 0.0) return through(a, b);
  return dot(axis, a) < 0.0 ? Rim{-axis, -dot(axis, a)} : Rim{axis, dot(axis, a)};
}

}  // namespace

SphericalCap smallest_spherical_cap(std::span<const Vec3> v) {
  Rim rim{v[0], 1.0};
  for (std::size_t i = 1; i < v.size(); ++i) {
    if (!rim.is_outside(v[i])) continue;
    rim = through(v[i], v[0]);
    for (std::size_t j = 1; j < i; ++j) {
      if (!rim.is_outside(v[j])) continue;
      rim = through(v[i], v[j]);
      for (std::size_t k = 0; k < j; ++k)
        if (rim.is_outside(v[k])) rim = through(v[i], v[j], v[k]);
    }
  }
  SphericalCap cap{rim.axis, 0.0};
  for (const Vec3& x : v) cap.angle = std::max(cap.angle, angle_between(x, cap.axis));
  return cap;
}

}  // namespace sterna
