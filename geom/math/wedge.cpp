// Tests the validity of the wedge (prism with bilinear sides) exactly, and computes its volume and quality.
//
// With a, b the edges 0-1, 0-2 of the base, a', b' those of the top, and d_k the growth edges, the Jacobian of the trilinear map at height z
// over corner k is N(z) . d_k with N(z) = (a + z (a' - a)) x (b + z (b' - b)). In Bernstein form over z its coefficients are
//   b0 = (a x b) . d_k,   2 b1 = (a x b' + a' x b) . d_k,   b2 = (a' x b') . d_k,
// which are the b0, b1, b2 of docs/method/validity.md, "Exact wedge test", free of cancelling terms. The Jacobian is positive along the growth edge iff b0 > 0,
// b2 > 0 and (b1 >= 0 or b1^2 < b0 b2). It is linear between the growth edges, so it is positive everywhere iff it is positive along all three.
//
// The floating-point filter uses only differences of coordinates, and a rounded difference is within one unit roundoff of the exact one relative to itself,
// however flat the wedge is and however far from the origin. A prism of height 1e-6 times its edges is therefore decided here unless it is nearly inverted.
#include <algorithm>
#include <array>
#include <limits>

#include "geom/math/expansion.h"
#include "geom/math/measures.h"

namespace sterna {
namespace {

using exact::Bounded;
using exact::difference;
using exact::Expansion;
using exact::LongExpansion;
using exact::Triple;

enum class Verdict { invalid, valid, undecided };

// Roundings carried by a term of a coefficient (rule at exact::Bounded): two differences, one product, one subtraction, and for 2 b1 one addition of the two
// cross products; then one difference, one product, two additions.
constexpr int k_wedge_roundings = 9;
constexpr double k_bound = (k_wedge_roundings + 1) * exact::k_unit;
// Relative margin for comparing -2 b1 with 2 sqrt(b0) sqrt(b2): two roots, two products, and the subtraction in the bounds make 5 roundings, which are doubled.
constexpr double k_root_margin = 10 * exact::k_unit;

/// Returns the Bernstein coefficients of N(z), the middle one doubled.
template <class T>
struct NormalCoefficients {
  decltype(cross(std::declval<Triple<T>>(), std::declval<Triple<T>>())) n0, n2;
  decltype(cross(std::declval<Triple<T>>(), std::declval<Triple<T>>()) + cross(std::declval<Triple<T>>(), std::declval<Triple<T>>())) n1_twice;
};

template <class T>
NormalCoefficients<T> normal_coefficients(const WedgePoints& p) {
  const Triple<T> a = difference<T>(p[0], p[1]), b = difference<T>(p[0], p[2]);
  const Triple<T> a_top = difference<T>(p[3], p[4]), b_top = difference<T>(p[3], p[5]);
  return {cross(a, b), cross(a_top, b_top), cross(a, b_top) + cross(a_top, b)};
}

/// Filters one growth edge, with intervals for b0, 2 b1 and b2.
Verdict filter_edge(const Bounded& b0, const Bounded& b1_twice, const Bounded& b2) {
  const double e0 = k_bound * b0.size;
  const double e1 = k_bound * b1_twice.size;
  const double e2 = k_bound * b2.size;
  if (b0.value <= -e0 || b2.value <= -e2) return Verdict::invalid;
  if (b0.value <= e0 || b2.value <= e2) return Verdict::undecided;
  const double worst = b1_twice.value - e1;
  if (worst >= 0.0) return Verdict::valid;
  // The roots are multiplied, not the coefficients: no underflow for tiny wedges.
  const double lowest = 2.0 * std::sqrt(b0.value - e0) * std::sqrt(b2.value - e2);
  if (-worst < lowest * (1.0 - k_root_margin)) return Verdict::valid;
  const double best = b1_twice.value + e1;
  const double highest = 2.0 * std::sqrt(b0.value + e0) * std::sqrt(b2.value + e2);
  if (-best > highest * (1.0 + k_root_margin)) return Verdict::invalid;
  return Verdict::undecided;
}

Verdict filter(const WedgePoints& p) {
  const auto n = normal_coefficients<Bounded>(p);
  Verdict verdict = Verdict::valid;
  for (std::size_t k = 0; k < 3; ++k) {
    const Triple<Bounded> d = difference<Bounded>(p[k], p[k + 3]);
    const Verdict edge = filter_edge(dot(n.n0, d), dot(n.n1_twice, d), dot(n.n2, d));
    if (edge == Verdict::invalid) return edge;
    if (edge == Verdict::undecided) verdict = edge;
  }
  return verdict;
}

bool is_wedge_valid_exactly(const WedgePoints& p) {
  // The filter cannot decide about these, and expansions would drop them when multiplied by zero.
  if (!std::all_of(p.begin(), p.end(), is_finite)) return false;
  const auto n = normal_coefficients<Expansion<2>>(p);
  for (std::size_t k = 0; k < 3; ++k) {
    const Triple<Expansion<2>> d = difference<Expansion<2>>(p[k], p[k + 3]);
    const auto b0 = dot(n.n0, d);
    const auto b2 = dot(n.n2, d);
    if (b0.sign() <= 0 || b2.sign() <= 0) return false;
    const auto b1_twice = dot(n.n1_twice, d);
    if (b1_twice.sign() >= 0) continue;
    // (2 b1)^2 < 4 b0 b2; the factor of four is exact in each component.
    LongExpansion four_b0(b0.view());
    four_b0 = four_b0 + four_b0;
    four_b0 = four_b0 + four_b0;
    const LongExpansion middle(b1_twice.view());
    if ((four_b0 * LongExpansion(b2.view()) - middle * middle).sign() <= 0) return false;
  }
  return true;
}

}  // namespace

bool is_wedge_valid(const WedgePoints& p) {
  const Verdict verdict = filter(p);
  return verdict == Verdict::undecided ? is_wedge_valid_exactly(p) : verdict == Verdict::valid;
}

double wedge_volume(const WedgePoints& p) {
  // Integral of the Jacobian: its mean over the triangle is the mean of the three edges, its mean over the height that of the three coefficients; the area
  // factor is 1/2.
  const Vec3 a = p[1] - p[0], b = p[2] - p[0];
  const Vec3 a_top = p[4] - p[3], b_top = p[5] - p[3];
  const Vec3 normal = cross(a, b) + 0.5 * (cross(a, b_top) + cross(a_top, b)) + cross(a_top, b_top);
  return dot(normal, (p[3] - p[0]) + (p[4] - p[1]) + (p[5] - p[2])) / 18.0;
}

double wedge_quality(const WedgePoints& p) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[0];
  const Vec3 a_top = p[4] - p[3], b_top = p[5] - p[3];
  const Vec3 n0 = cross(a, b);
  const Vec3 n1 = 0.5 * (cross(a, b_top) + cross(a_top, b));
  const Vec3 n2 = cross(a_top, b_top);
  // Edges opposite to corners 0, 1, 2.
  const std::array<double, 3> base = {distance(p[1], p[2]), norm(b), norm(a)};
  const std::array<double, 3> top = {distance(p[4], p[5]), norm(b_top), norm(a_top)};
  double quality = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 d = p[k + 3] - p[k];
    const double height = norm(d);
    const double base_scale = base[(k + 1) % 3] * base[(k + 2) % 3] * height;
    const double top_scale = top[(k + 1) % 3] * top[(k + 2) % 3] * height;
    // A corner of zero extent has a zero Jacobian.
    if (!(base_scale > 0.0) || !(top_scale > 0.0)) return std::min(quality, 0.0);
    const double b0 = dot(n0, d);
    const double b1 = dot(n1, d);
    const double b2 = dot(n2, d);
    quality = std::min({quality, b0 / base_scale, b2 / top_scale});
    if (b0 > 0.0 && b2 > 0.0) {
      const double middle = b1 + std::sqrt(b0) * std::sqrt(b2);
      quality = std::min(quality, middle / (2.0 * std::sqrt(base_scale) * std::sqrt(top_scale)));
    }
  }
  return quality;
}

}  // namespace sterna
