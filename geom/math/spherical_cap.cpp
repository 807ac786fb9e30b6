// Based on the fact that a vector outside the cap of its predecessors lies on the boundary of the new cap.
#include "geom/math/spherical_cap.h"

#include <algorithm>

namespace sterna {
namespace {

/// A vector this much (in cosine) outside a cap still counts as inside: far below any relevant angle, far above rounding.
constexpr double k_slack = 1e-12;

struct CapCircle {
  Vec3 axis;
  double cosine;
  bool is_outside(const Vec3& v) const { return dot(v, axis) < cosine - k_slack; }
};

CapCircle through(const Vec3& a, const Vec3& b) {
  const Vec3 axis = normalized(a + b);
  return {axis, dot(axis, a)};
}

/// Returns the cap through the three vectors, on their side; through two of them if they are nearly collinear on the sphere.
CapCircle through(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 axis = normalized(cross(b - a, c - a));
  if (norm2(axis) == 0.0) return through(a, b);
  return dot(axis, a) < 0.0 ? CapCircle{-axis, -dot(axis, a)} : CapCircle{axis, dot(axis, a)};
}

}  // namespace

SphericalCap smallest_spherical_cap(std::span<const Vec3> v) {
  CapCircle circle{v[0], 1.0};
  for (std::size_t i = 1; i < v.size(); ++i) {
    if (!circle.is_outside(v[i])) continue;
    circle = through(v[i], v[0]);
    for (std::size_t j = 1; j < i; ++j) {
      if (!circle.is_outside(v[j])) continue;
      circle = through(v[i], v[j]);
      for (std::size_t k = 0; k < j; ++k)
        if (circle.is_outside(v[k])) circle = through(v[i], v[j], v[k]);
    }
  }
  SphericalCap cap{circle.axis, 0.0};
  for (const Vec3& x : v) cap.angle = std::max(cap.angle, angle_between(x, cap.axis));
  return cap;
}

}  // namespace sterna
