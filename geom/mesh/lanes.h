// SIMD over four layers of a column: packed doubles and vectors, and growth lines with separate coordinate arrays. Private to the *.cpp files of geom/mesh.
// The project is built for x86-64-v3 (AVX2); every operation is rounded like its scalar counterpart.
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"

namespace sterna::lanes {

inline constexpr std::size_t k_width = 4;
using Packed [[gnu::vector_size(8 * k_width)]] = double;
using Unaligned [[gnu::vector_size(8 * k_width), gnu::aligned(8), gnu::may_alias]] = double;

inline Packed load(const std::vector<double>& values, std::size_t i) { return *reinterpret_cast<const Unaligned*>(values.data() + i); }
inline void store(std::vector<double>& values, std::size_t i, Packed v) { *reinterpret_cast<Unaligned*>(values.data() + i) = v; }
inline Packed all(double value) { return Packed{value, value, value, value}; }
inline Packed least(Packed a, Packed b) { return _mm256_min_pd(a, b); }
inline Packed most(Packed a, Packed b) { return _mm256_max_pd(a, b); }
inline Packed root(Packed a) { return _mm256_sqrt_pd(a); }
inline Packed magnitude(Packed a) { return _mm256_andnot_pd(all(-0.0), a); }

/// Returns asin with an error of 2e-8 (a millionth of a degree) without branches: Abramowitz & Stegun 4.4.46.
inline Packed arc_sine(Packed x) {
  const Packed one = all(1.0);
  const Packed size = least(one, most(x, -x));
  Packed p = all(-0.0012624911);
  for (const double coefficient : {0.0066700901, -0.0170881256, 0.0308918810, -0.0501743046, 0.0889789874, -0.2145988016, 1.5707963050})
    p = p * size + coefficient;
  const Packed angle = all(0.5 * std::numbers::pi) - root(one - size) * p;
  return x < all(0.0) ? -angle : angle;
}

/// Returns acos of values in [-1, 1] with an error of two roundings, without branches: asin(s) = s + s R(s^2) up to 1/2, twice the value of the half angle
/// beyond; R is from fdlibm.
inline Packed arc_cosine(Packed x) {
  const Packed half = all(0.5), size = magnitude(x);
  const auto is_small = size < half;
  const Packed z = is_small ? size * size : (all(1.0) - size) * half;
  const Packed s = is_small ? size : root(z);
  Packed p = all(3.47933107596021167570e-05), q = all(7.70381505559019352791e-02);
  for (const double coefficient :
       {7.91534994289814532176e-04, -4.00555345006794114027e-02, 2.01212532134862925881e-01, -3.25565818622400915405e-01, 1.66666666666666657415e-01})
    p = p * z + coefficient;
  for (const double coefficient : {-6.88283971605453293030e-01, 2.02094576023350569471e+00, -2.40339491173441421878e+00, 1.0}) q = q * z + coefficient;
  const Packed angle = s + s * (p * z / q);
  const Packed of_size = is_small ? all(0.5 * std::numbers::pi) - angle : 2.0 * angle;
  return x < all(0.0) ? all(std::numbers::pi) - of_size : of_size;
}

/// Four vectors.
struct Vec3x4 {
  Packed x, y, z;
  friend Vec3x4 operator+(const Vec3x4& a, const Vec3x4& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3x4 operator-(const Vec3x4& a, const Vec3x4& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3x4 operator*(double s, const Vec3x4& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Vec3x4 operator*(Packed s, const Vec3x4& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Vec3x4 operator/(const Vec3x4& a, Packed s) { return {a.x / s, a.y / s, a.z / s}; }
};
inline Packed dot(const Vec3x4& a, const Vec3x4& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Packed norm(const Vec3x4& a) { return root(dot(a, a)); }
inline Vec3x4 cross(const Vec3x4& a, const Vec3x4& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/// Returns the length of the arrays below for a line of this many layers: four lanes may be read from any of its nodes, and from the node above.
inline std::size_t padded_size(int n_layers) {
  const auto n_nodes = static_cast<std::size_t>(std::max(n_layers, 0)) + 1;
  return (n_nodes + k_width - 1) / k_width * k_width + k_width;
}

/// Vectors along a line, by layer.
struct LineVectors {
  std::vector<double> x, y, z;
  void assign(std::size_t n, double value) {
    for (std::vector<double>* values : {&x, &y, &z}) values->assign(n, value);
  }
  Vec3x4 at(std::size_t i) const { return {load(x, i), load(y, i), load(z, i)}; }
  void add(std::size_t i, const Vec3x4& v) {
    store(x, i, load(x, i) + v.x);
    store(y, i, load(y, i) + v.y);
    store(z, i, load(z, i) + v.z);
  }
  /// Reads the points of a line that is not collapsed; beyond the end of the line the last point is repeated.
  void read(const HybridMesh& mesh, std::uint32_t line) {
    const int n_layers = mesh.layers.layers_of_line(line);
    const auto n_nodes = static_cast<std::size_t>(n_layers) + 1;
    const std::size_t n = padded_size(n_layers);
    const Point* points = mesh.points.raw().data() + mesh.layers.first_node[line];
    x.resize(n);
    y.resize(n);
    z.resize(n);
    static_assert(sizeof(Point) == 3 * sizeof(double));
    std::size_t j = 0;
    for (; j + k_width <= n_nodes; j += k_width) {
      const auto* values = reinterpret_cast<const double*>(points + j);  // x y z x | y z x y | z x y z
      const Packed first = _mm256_loadu_pd(values), second = _mm256_loadu_pd(values + 4), third = _mm256_loadu_pd(values + 8);
      const Packed xy = _mm256_permute2f128_pd(first, second, 0x30), zx = _mm256_permute2f128_pd(first, third, 0x21),
                   yz = _mm256_permute2f128_pd(second, third, 0x30);
      store(x, j, _mm256_shuffle_pd(xy, zx, 0b1010));
      store(y, j, _mm256_shuffle_pd(xy, yz, 0b0101));
      store(z, j, _mm256_shuffle_pd(zx, yz, 0b1010));
    }
    for (; j < n; ++j) {
      const Point& p = points[std::min(j, n_nodes - 1)];
      x[j] = p.x;
      y[j] = p.y;
      z[j] = p.z;
    }
  }
};

}  // namespace sterna::lanes
