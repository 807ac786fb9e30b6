#include "geom/math/insphere.h"

#include "geom/math/expansion.h"

namespace sterna {
namespace {

// Roundings carried by a term (rule at exact::Bounded). Lift: the difference twice, a square, two additions (5). Volume: minor (4), difference, product, two
// additions (8). Then their product and two additions.
constexpr int k_insphere_roundings = 17;

template <class T>
auto insphere_determinant(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  using exact::difference;
  const auto pa = difference<T>(e, a), pb = difference<T>(e, b), pc = difference<T>(e, c), pd = difference<T>(e, d);
  const auto ab = cross(pa, pb), cd = cross(pc, pd);
  return (dot(pa, pa) * dot(cd, pb) - dot(pb, pb) * dot(cd, pa)) + (dot(pc, pc) * dot(ab, pd) - dot(pd, pd) * dot(ab, pc));
}

}  // namespace

int insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  constexpr int k_open = 2;
  const int sign = insphere_determinant<exact::Bounded>(a, b, c, d, e).sign(k_insphere_roundings);
  return sign != k_open ? sign : insphere_determinant<exact::LongExpansion>(a, b, c, d, e).sign();
}

}  // namespace sterna
