// The corner is the origin. o and r are the sums over the face's other nodes and over the rest of the cell's nodes; k and n are the node counts of face and
// cell. Then the midpoint is m = next/2, the face's centroid f = (next + o)/k, the cell's centroid c = (next + o + r)/n, and det(m, f, c) = det(next, o, r) /
// (2 k n). Expansions compute the remaining differences, sums and products exactly.
#include "geom/math/sub_volumes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/math/expansion.h"

namespace sterna {
namespace {

using exact::Bounded;
using exact::LongExpansion;
using exact::Triple;

/// Roundings carried by a term (rule at exact::Bounded). The three factors have one difference each and at most 0, 1 and 3 additions. Then follow two products,
/// one subtraction, and the two additions of the dot product.
constexpr int k_sub_volume_roundings = 3 + 4 + 5;

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

/// Above this value times the cube of the cell's size (root of the sum of its squared edges), a computed six-fold sub-volume is certainly positive. Its three
/// factors are at most of that size, each within 7 roundings of its exact value; multiplying and summing add some 10 more. The sum is doubled.
constexpr double k_certain = 64 * exact::k_unit;

/// Returns the smallest six-fold sub-volume of a wedge relative to the cube of its size, visiting each of its nine edges and their two faces once.
double least_relative_sub_volume(const WedgePoints& p) {
  double size2 = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const Vec3 b0 = p[i] - p[k], c0 = p[j] - p[k], b1 = p[i + 3] - p[k + 3], c1 = p[j + 3] - p[k + 3], up = p[k + 3] - p[k];
    const Vec3 middle = (b0 + c0 + b1 + c1) / 6.0;
    const Vec3 side_b = 0.25 * (b0 + b1), side_c = 0.25 * (c0 + c1), half_up = 0.5 * up;
    size2 += norm2(b0) + norm2(b1) + norm2(up);
    const auto note = [&](const Vec3& before, const Vec3& after, const Vec3& moment) { least = std::min({least, dot(before, moment), -dot(after, moment)}); };
    note((b0 + c0) / 3.0, side_b + half_up, cross(middle + half_up, 0.5 * b0));
    note(side_b - half_up, (b1 + c1) / 3.0, cross(middle - half_up, 0.5 * b1));
    note(side_b, side_c, cross(middle, half_up));  // the edge itself has no moment about its midpoint
  }
  return size2 > 0.0 ? least / (size2 * std::sqrt(size2)) : 0.0;
}

bool is_positive(const Vec3& corner, const Vec3& next, std::initializer_list<Vec3> others, std::initializer_list<Vec3> rest) {
  return sub_volume_sign(corner, next, {others.begin(), others.size()}, {rest.begin(), rest.size()}) > 0;
}

}  // namespace

int sub_volume_sign(const Vec3& corner, const Vec3& next, std::span<const Vec3> others, std::span<const Vec3> rest) {
  constexpr int k_undecided = 2;
  const int sign = determinant<Bounded>(corner, next, others, rest).sign(k_sub_volume_roundings);
  return -(sign != k_undecided ? sign : determinant<LongExpansion>(corner, next, others, rest).sign());
}

bool are_sub_volumes_positive(const WedgePoints& p) {
  if (least_relative_sub_volume(p) > k_certain) return true;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const Vec3 &a = p[k], &b = p[i], &c = p[j], &a1 = p[k + 3], &b1 = p[i + 3], &c1 = p[j + 3];
    if (!is_positive(b, a, {c}, {a1, b1, c1})) return false;  // bottom, runs c b a
    if (!is_positive(a1, b1, {c1}, {a, b, c})) return false;  // top
    if (!is_positive(a, b, {b1, a1}, {c, c1})) return false;  // side a b b1 a1, four edges
    if (!is_positive(b, b1, {a1, a}, {c, c1})) return false;
    if (!is_positive(b1, a1, {a, b}, {c, c1})) return false;
    if (!is_positive(a1, a, {b, b1}, {c, c1})) return false;
  }
  return true;
}

bool are_sub_volumes_positive(const std::array<Vec3, 5>& p) {
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 &a = p[k], &b = p[(k + 1) % 4], &c = p[(k + 2) % 4], &d = p[(k + 3) % 4], &apex = p[4];
    if (!is_positive(b, a, {d, c}, {apex})) return false;  // base, runs d c b a
    if (!is_positive(a, b, {apex}, {c, d})) return false;  // side a b apex, three edges
    if (!is_positive(b, apex, {a}, {c, d})) return false;
    if (!is_positive(apex, a, {b}, {c, d})) return false;
  }
  return true;
}

}  // namespace sterna
