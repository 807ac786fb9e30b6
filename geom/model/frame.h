// Frames and affine maps of space.
#pragma once

#include "geom/base/vec3.h"

namespace sterna {

/// Right- or left-handed orthonormal frame.
struct Frame {
  Point origin;
  Vec3 x{1.0, 0.0, 0.0};
  Vec3 y{0.0, 1.0, 0.0};
  Vec3 z{0.0, 0.0, 1.0};
  /// In the frame's own coordinates.
  Vec3 local(const Point& p) const { return {dot(p - origin, x), dot(p - origin, y), dot(p - origin, z)}; }
  Point global(const Vec3& p) const { return origin + p.x * x + p.y * y + p.z * z; }
};

/// Right-handed frame with the given z axis (any length); x as near to `x_hint` as it can be, any direction when that is empty or along z.
Frame frame_along(const Point& origin, const Vec3& z, const Vec3& x_hint = {});

/// p -> p.x * x + p.y * y + p.z * z + shift. Columns, not rows.
struct Transform {
  Vec3 x{1.0, 0.0, 0.0};
  Vec3 y{0.0, 1.0, 0.0};
  Vec3 z{0.0, 0.0, 1.0};
  Vec3 shift;

  Vec3 vector(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
  Point point(const Point& p) const { return vector(p) + shift; }
  double determinant() const { return dot(x, cross(y, z)); }
  /// Rotations, moves, mirrors and equal scaling: all angles stay.
  bool is_similarity() const;
  /// Mean factor of lengths: the cube root of the determinant's size.
  double scale() const { return std::cbrt(std::abs(determinant())); }
  /// \throws Error(bad_argument) when space is flattened
  Transform inverse() const;
  friend bool operator==(const Transform&, const Transform&) = default;
};
/// First `b`, then `a`.
Transform operator*(const Transform& a, const Transform& b);

Transform translation(const Vec3& shift);
/// Right-hand rule about the axis through `at`, radians.
/// \throws Error(bad_argument) for an axis without a direction
Transform rotation(const Point& at, const Vec3& axis, double angle);
/// \throws Error(bad_argument) unless factor > 0
Transform scaling(const Point& about, double factor);
/// Mirror image in the plane through `at`.
/// \throws Error(bad_argument) for a normal without a direction
Transform mirroring(const Point& at, const Vec3& normal);

}  // namespace sterna
