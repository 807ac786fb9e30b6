// Hexahedron with bilinear faces: volume, and a conservative test that its Jacobian is positive everywhere.
//
// The Jacobian of the trilinear map is of degree two in each coordinate; its Bernstein coefficients bound it from below, and bisecting the
// cube makes the bound as sharp as required. The coefficients are sums of determinants of edge vectors:
//   J = det( sum a_jk, sum b_ik, sum c_ij )  with the four edges a along the first coordinate, b the second, c the third,
//   coefficient (p, q, r) = sum over i + i' = p, j + j' = q, k + k' = r of det(a_jk, b_ik', c_i'j') / (binom(2,p) binom(2,q) binom(2,r)).
// Based on: A. Johnen, J.-F. Remacle, C. Geuzaine, "Geometrical validity of curvilinear finite elements", J. Comput. Phys. 233 (2013).
#include <algorithm>
#include <array>
#include <cmath>

#include "geom/math/expansion.h"
#include "geom/math/measures.h"

namespace sterna {
namespace {

using exact::Bounded;
using exact::difference;
using exact::Triple;

/// Bisections of the cube before giving up; a cell that is then undecided has a Jacobian within 1e-5 of its largest value from zero.
constexpr int k_max_bisections = 24;
// Roundings of one of the up to eight summed determinants: 8 as in orient3d, and seven additions; the division by a power of two is exact.
constexpr int k_hexahedron_roundings = 15;

/// CGNS corner (0-7) at lattice position i, j, k in {0, 1}.
constexpr std::size_t corner(std::size_t i, std::size_t j, std::size_t k) {
  constexpr std::size_t k_ring[2][2] = {{0, 3}, {1, 2}};
  return k_ring[i][j] + 4 * k;
}
constexpr std::size_t slot(std::size_t p, std::size_t q, std::size_t r) { return p + 3 * q + 9 * r; }

struct Coefficients {
  std::array<double, 27> value;
  double error;  ///< bound on the error of each coefficient
};

Coefficients jacobian_coefficients(const std::array<Vec3, 8>& p) {
  std::array<Bounded, 27> sum{};
  using Edges = std::array<std::array<Triple<Bounded>, 2>, 2>;
  Edges along_i{}, along_j{}, along_k{};
  for (std::size_t u = 0; u < 2; ++u) {
    for (std::size_t v = 0; v < 2; ++v) {
      along_i[u][v] = difference<Bounded>(p[corner(0, u, v)], p[corner(1, u, v)]);
      along_j[u][v] = difference<Bounded>(p[corner(u, 0, v)], p[corner(u, 1, v)]);
      along_k[u][v] = difference<Bounded>(p[corner(u, v, 0)], p[corner(u, v, 1)]);
    }
  }
  for (std::size_t bits = 0; bits < 64; ++bits) {
    const std::size_t j = bits & 1, k = bits >> 1 & 1, i = bits >> 2 & 1, k2 = bits >> 3 & 1, i2 = bits >> 4 & 1, j2 = bits >> 5 & 1;
    Bounded& s = sum[slot(i + i2, j + j2, k + k2)];
    s = s + dot(cross(along_i[j][k], along_j[i][k2]), along_k[i2][j2]);
  }
  Coefficients result{{}, 0.0};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t q = 0; q < 3; ++q) {
      for (std::size_t pp = 0; pp < 3; ++pp) {
        const double binomials = (pp == 1 ? 2.0 : 1.0) * (q == 1 ? 2.0 : 1.0) * (r == 1 ? 2.0 : 1.0);
        const Bounded& s = sum[slot(pp, q, r)];
        result.value[slot(pp, q, r)] = s.value / binomials;
        result.error = std::max(result.error, (k_hexahedron_roundings + 1) * exact::k_unit * s.size / binomials);
      }
    }
  }
  return result;
}

/// Applies De Casteljau's rule at the middle along the axis of stride 1, 3 or 9.
std::array<Coefficients, 2> bisect(const Coefficients& c, std::size_t stride) {
  Coefficients low = c;
  Coefficients high = c;
  double largest = 0.0;
  for (std::size_t at = 0; at < 27; ++at) {
    largest = std::max(largest, std::abs(c.value[at]));
    if (at / stride % 3 != 0) continue;
    const double c0 = c.value[at], c1 = c.value[at + stride], c2 = c.value[at + 2 * stride];
    const double left = 0.5 * (c0 + c1), right = 0.5 * (c1 + c2);
    low.value[at + stride] = left;
    high.value[at + stride] = right;
    low.value[at + 2 * stride] = high.value[at] = 0.5 * (left + right);
  }
  // At most two additions, each within one unit roundoff of the largest coefficient.
  low.error = high.error = c.error + 2.0 * exact::k_unit * largest;
  return {low, high};
}

bool is_positive(const Coefficients& c, int bisections) {
  // The coefficients at the corners are values of the Jacobian: if one is not certainly positive, the proof fails.
  for (const std::size_t r : {0u, 2u}) {
    for (const std::size_t q : {0u, 2u}) {
      for (const std::size_t p : {0u, 2u}) {
        if (c.value[slot(p, q, r)] <= c.error) return false;
      }
    }
  }
  if (*std::min_element(c.value.begin(), c.value.end()) > c.error) return true;
  if (bisections == k_max_bisections) return false;
  constexpr std::size_t k_strides[3] = {1, 3, 9};
  const auto halves = bisect(c, k_strides[bisections % 3]);
  return is_positive(halves[0], bisections + 1) && is_positive(halves[1], bisections + 1);
}

}  // namespace

double hexahedron_volume(const std::array<Vec3, 8>& p) {
  // Outward faces in CGNS order. The flux is taken relative to corner 0, whose three faces have a flux only if they are warped.
  constexpr std::size_t k_faces[6][4] = {{0, 3, 2, 1}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {4, 5, 6, 7}};
  double volume = 0.0;
  for (const auto& [a, b, c, d] : k_faces) volume += bilinear_flux(p[0], p[a], p[b], p[c], p[d]);
  return volume;
}

bool is_hexahedron_valid(const std::array<Vec3, 8>& p) { return is_positive(jacobian_coefficients(p), 0); }

}  // namespace sterna
