#include "geom/model/frame.h"

#include <algorithm>
#include <string>

#include "geom/base/error.h"

namespace sterna {
namespace {

/// Relative tolerance of lengths and angles of a similarity. It covers the rounding of products of a few maps.
constexpr double k_similar = 1e-12;

Vec3 direction_of(const Vec3& v, const char* attempted) {
  const double length = norm(v);
  if (!(length > 0.0) || !std::isfinite(length))
    throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = "the direction " + format_point(v) + " has no length"});
  return v / length;
}

}  // namespace

Frame frame_along(const Point& origin, const Vec3& z, const Vec3& x_hint) {
  Frame frame;
  frame.origin = origin;
  frame.z = direction_of(z, "making a frame");
  constexpr double k_parallel = 1e-9;  // sine of the angle between hint and axis
  Vec3 x = x_hint - dot(x_hint, frame.z) * frame.z;
  if (!(norm(x) > k_parallel * norm(x_hint))) {
    const Vec3 size{std::abs(frame.z.x), std::abs(frame.z.y), std::abs(frame.z.z)};
    const Vec3 other = size.x <= size.y && size.x <= size.z ? Vec3{1.0, 0.0, 0.0} : size.y <= size.z ? Vec3{0.0, 1.0, 0.0} : Vec3{0.0, 0.0, 1.0};
    x = other - dot(other, frame.z) * frame.z;
  }
  frame.x = normalized(x);
  frame.y = cross(frame.z, frame.x);
  return frame;
}

bool Transform::is_similarity() const {
  const double xx = norm2(x), yy = norm2(y), zz = norm2(z);
  const double size = std::max({xx, yy, zz});
  return size > 0.0 && std::max({std::abs(xx - yy), std::abs(yy - zz), std::abs(dot(x, y)), std::abs(dot(y, z)), std::abs(dot(z, x))}) <= k_similar * size;
}

Transform Transform::inverse() const {
  const double d = determinant();
  if (!(std::abs(d) > 0.0))
    throw Error(
        {.code = ErrorCode::bad_argument, .attempted = "inverting a transformation", .problem = "the transformation flattens space: its determinant is 0"});
  const Vec3 a = cross(y, z) / d, b = cross(z, x) / d, c = cross(x, y) / d;  // rows of the inverse
  Transform result{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, {}};
  result.shift = -result.vector(shift);
  return result;
}

Transform operator*(const Transform& a, const Transform& b) { return {a.vector(b.x), a.vector(b.y), a.vector(b.z), a.point(b.shift)}; }

Transform translation(const Vec3& shift) {
  Transform t;
  t.shift = shift;
  return t;
}

Transform rotation(const Point& at, const Vec3& axis, double angle) {
  const Vec3 a = direction_of(axis, "rotating");
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turned = [&](const Vec3& v) { return c * v + s * cross(a, v) + (1.0 - c) * dot(a, v) * a; };
  Transform t{turned({1.0, 0.0, 0.0}), turned({0.0, 1.0, 0.0}), turned({0.0, 0.0, 1.0}), {}};
  t.shift = at - t.vector(at);
  return t;
}

Transform scaling(const Point& about, double factor) {
  if (!(factor > 0.0) || !std::isfinite(factor))
    throw Error({.code = ErrorCode::bad_argument, .attempted = "scaling", .problem = "the factor is " + std::to_string(factor) + ", must be positive"});
  return {{factor, 0.0, 0.0}, {0.0, factor, 0.0}, {0.0, 0.0, factor}, (1.0 - factor) * about};
}

Transform mirroring(const Point& at, const Vec3& normal) {
  const Vec3 n = direction_of(normal, "mirroring");
  const auto image = [&](const Vec3& v) { return v - 2.0 * dot(n, v) * n; };
  return {image({1.0, 0.0, 0.0}), image({0.0, 1.0, 0.0}), image({0.0, 0.0, 1.0}), 2.0 * dot(n, at) * n};
}

}  // namespace sterna
