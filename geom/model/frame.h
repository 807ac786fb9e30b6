// Coordinate frames and affine maps of space.
#pragma once

#include "geom/base/vec3.h"

namespace sterna {

/// Right- or left-handed orthonormal frame.
struct Frame {
  Point origin;
  Vec3 x{1.0, 0.0, 0.0};
  Vec3 y{0.0, 1.0, 0.0};
  Vec3 z{0.0, 0.0, 1.0};
  /// Returns the coordinates of a point in the frame.
  Vec3 local(const Point& p) const { return {dot(p - origin, x), dot(p - origin, y), dot(p - origin, z)}; }
  Point global(const Vec3& p) const { return origin + p.x * x + p.y * y + p.z * z; }
};

/// Returns a right-handed frame with the given z axis (any length). Its x axis is as close to `x_hint` as possible; it has any direction if `x_hint` is empty
/// or parallel to z.
Frame frame_along(const Point& origin, const Vec3& z, const Vec3& x_hint = {});

/// The affine map p -> p.x * x + p.y * y + p.z * z + shift. x, y and z are columns of the matrix, not rows.
struct Transform {
  Vec3 x{1.0, 0.0, 0.0};
  Vec3 y{0.0, 1.0, 0.0};
  Vec3 z{0.0, 0.0, 1.0};
  Vec3 shift;

  Vec3 vector(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
  Point point(const Point& p) const { return vector(p) + shift; }
  double determinant() const { return dot(x, cross(y, z)); }
  /// Returns true for rotations, translations, mirrors and uniform scaling: all angles are preserved.
  bool is_similarity() const;
  /// Returns the mean scale factor of lengths: the cube root of the determinant's magnitude.
  double scale() const { return std::cbrt(std::abs(determinant())); }
  /// \throws Error(bad_argument) if the map is singular
  Transform inverse() const;
  friend bool operator==(const Transform&, const Transform&) = default;
};
/// Applies `b` first, then `a`.
Transform operator*(const Transform& a, const Transform& b);

Transform translation(const Vec3& shift);
/// Returns the rotation by the right-hand rule about the axis through `at`, radians.
/// \throws Error(bad_argument) for an axis of zero length
Transform rotation(const Point& at, const Vec3& axis, double angle);
/// \throws Error(bad_argument) unless factor > 0
Transform scaling(const Point& about, double factor);
/// Returns the reflection in the plane through `at`.
/// \throws Error(bad_argument) for a normal of zero length
Transform mirroring(const Point& at, const Vec3& normal);

}  // namespace sterna
