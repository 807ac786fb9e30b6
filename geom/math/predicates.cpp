// Signs of the classic determinants. Each formula is written once, over a number type: first evaluated in doubles with a forward error bound
// (exact::Bounded), then, if that cannot decide, in exact arithmetic. Based on: Shewchuk 1997 (see expansion.h).
#include "geom/math/predicates.h"

#include "geom/math/expansion.h"

namespace sterna {
namespace {

using exact::Bounded;
using exact::difference;
using exact::Expansion;

// Roundings carried by a term of each determinant as written below (rule at exact::Bounded).
// orient2d: two differences, one product, one subtraction.
constexpr int k_orient2d_roundings = 4;
// orient3d: minor as in orient2d (4), one difference, one product, two additions.
constexpr int k_orient3d_roundings = 8;
// incircle: minor (4); lift: the difference twice, a square, an addition (4); then a product and two additions.
constexpr int k_incircle_roundings = 11;

template <class T>
auto orient2d_determinant(const Vec2& a, const Vec2& b, const Vec2& c) {
  return difference<T>(a.x, b.x) * difference<T>(a.y, c.y) - difference<T>(a.y, b.y) * difference<T>(a.x, c.x);
}

template <class T>
auto orient3d_determinant(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return dot(cross(difference<T>(a, b), difference<T>(a, c)), difference<T>(a, d));
}

template <class T>
auto incircle_determinant(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const T ax = difference<T>(d.x, a.x), ay = difference<T>(d.y, a.y);
  const T bx = difference<T>(d.x, b.x), by = difference<T>(d.y, b.y);
  const T cx = difference<T>(d.x, c.x), cy = difference<T>(d.y, c.y);
  return (ax * ax + ay * ay) * (bx * cy - by * cx) + (bx * bx + by * by) * (cx * ay - cy * ax) + (cx * cx + cy * cy) * (ax * by - ay * bx);
}

constexpr int k_undecided = 2;

}  // namespace

int orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  const int sign = orient2d_determinant<Bounded>(a, b, c).sign(k_orient2d_roundings);
  return sign != k_undecided ? sign : orient2d_determinant<Expansion<2>>(a, b, c).sign();
}

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int sign = orient3d_determinant<Bounded>(a, b, c, d).sign(k_orient3d_roundings);
  return sign != k_undecided ? sign : orient3d_determinant<Expansion<2>>(a, b, c, d).sign();
}

int incircle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const int sign = incircle_determinant<Bounded>(a, b, c, d).sign(k_incircle_roundings);
  return sign != k_undecided ? sign : incircle_determinant<Expansion<2>>(a, b, c, d).sign();
}

}  // namespace sterna
