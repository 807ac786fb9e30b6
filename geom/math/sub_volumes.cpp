// With the corner as origin, m = next/2, f = (next + o)/k, c = (next + o + r)/n with o, r the sums over the face's others and the rest, k and n node counts:
// det(m, f, c) = det(next, o, r) / (2 k n). Differences, sums and products are what expansions do exactly.
#include "geom/math/sub_volumes.h"

#include "geom/math/expansion.h"

namespace sterna {
namespace {

using exact::Bounded;
using exact::LongExpansion;
using exact::Triple;

/// Roundings carried by a term (rule at exact::Bounded): the three factors have one difference each and at most 0, 1 and 3 additions; two products, one
/// subtraction, two additions of the dot product.
constexpr int k_roundings = 3 + 4 + 5;

template <class T>
Triple<T> sum_of_differences(const Vec3& origin, std::span<const Vec3> points) {
  Triple<T> sum = exact::difference<T>(origin, points[0]);
  for (std::size_t i = 1; i < points.size(); ++i) sum = sum + exact::difference<T>(origin, points[i]);
  return sum;
}

template <class T>
T determinant(const Vec3& corner, const Vec3& next, std::span<const Vec3> others, std::span<const Vec3> rest) {
  return dot(cross(sum_of_differences<T>(corner, others), sum_of_differences<T>(corner, rest)), exact::difference<T>(corner, next));
}

}  // namespace

int sub_volume_sign(const Vec3& corner, const Vec3& next, std::span<const Vec3> others, std::span<const Vec3> rest) {
  constexpr int k_undecided = 2;
  const int sign = determinant<Bounded>(corner, next, others, rest).sign(k_roundings);
  return -(sign != k_undecided ? sign : determinant<LongExpansion>(corner, next, others, rest).sign());
}

}  // namespace sterna
