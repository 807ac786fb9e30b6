// Exact arithmetic on sums of doubles ("expansions"), private to geom/math.
//
// An expansion is a list of doubles, ordered by increasing magnitude, whose bits do not overlap; its value is the exact sum and its sign the
// sign of the last one. Zero components are dropped, so zero is the empty list. All operations are exact as long as no product
// overflows or underflows. The same formula, written once as a template, is evaluated with
//   Bounded        double with the sum of the absolute values of its terms: the filter;
//   Expansion<N>   exact, at most N components, on the stack;
//   LongExpansion  exact, any number of components, on the heap.
// Based on: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates", Discrete & Computational
// Geometry 18 (1997); with the fused multiply-add the error of a product needs no splitting. Needs round-to-nearest-even and no contraction.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::exact {

/// Unit roundoff: a floating-point operation gives fl(x op y) = (x op y)(1 + d) with |d| <= k_unit.
inline constexpr double k_unit = 0x1p-53;

/// Computes sum and error so that sum + error == a + b exactly.
inline void two_sum(double a, double b, double& sum, double& error) {
  sum = a + b;
  const double b_part = sum - a;
  error = (a - (sum - b_part)) + (b - b_part);
}
/// As two_sum, but requires |a| >= |b| or a == 0.
inline void fast_two_sum(double a, double b, double& sum, double& error) {
  sum = a + b;
  error = b - (sum - a);
}
/// Computes product and error so that product + error == a * b exactly.
inline void two_product(double a, double b, double& product, double& error) {
  product = a * b;
  error = std::fma(a, b, -product);
}

/// Computes h = e + f and returns the number of components. h must hold at least e.size() + f.size() components and overlap neither operand.
/// (Fast-Expansion-Sum.)
inline std::size_t add(std::span<const double> e, std::span<const double> f, double* h) {
  std::size_t i = 0;
  std::size_t j = 0;
  std::size_t n = 0;
  const auto next_by_magnitude = [&] {
    if (j == f.size() || (i < e.size() && std::abs(e[i]) < std::abs(f[j]))) return e[i++];
    return f[j++];
  };
  const std::size_t total = e.size() + f.size();
  if (total == 0) return 0;
  double sum = next_by_magnitude();
  while (i + j < total) {
    double error;
    two_sum(sum, next_by_magnitude(), sum, error);
    if (error != 0.0) h[n++] = error;
  }
  if (sum != 0.0) h[n++] = sum;
  return n;
}

/// Computes h = b e and returns the number of components. h must hold at least 2 e.size() components and not overlap e. (Scale-Expansion.)
inline std::size_t scale(std::span<const double> e, double b, double* h) {
  if (e.empty() || b == 0.0) return 0;
  std::size_t n = 0;
  double sum;
  double error;
  two_product(e[0], b, sum, error);
  if (error != 0.0) h[n++] = error;
  for (std::size_t i = 1; i < e.size(); ++i) {
    double product;
    double product_error;
    two_product(e[i], b, product, product_error);
    double partial;
    two_sum(sum, product_error, partial, error);
    if (error != 0.0) h[n++] = error;
    fast_two_sum(product, partial, sum, error);
    if (error != 0.0) h[n++] = error;
  }
  if (sum != 0.0) h[n++] = sum;
  return n;
}

/// Computes h = e f and returns the number of components. h and work must hold at least 2 e.size() f.size() components each, term at least 2 e.size(); none may
/// overlap.
inline std::size_t multiply(std::span<const double> e, std::span<const double> f, double* h, double* work, double* term) {
  if (f.empty()) return 0;
  // The sum alternates between the two buffers; start so that the last one is written to h.
  double* from = f.size() % 2 == 1 ? h : work;
  double* to = f.size() % 2 == 1 ? work : h;
  std::size_t n = scale(e, f[0], from);
  for (std::size_t j = 1; j < f.size(); ++j) {
    const std::size_t n_term = scale(e, f[j], term);
    n = add({from, n}, {term, n_term}, to);
    std::swap(from, to);
  }
  return n;
}

inline int sign_of(double value) { return (value > 0.0) - (value < 0.0); }

/// Exact number with at most N components.
template <std::size_t N>
class Expansion {
 public:
  // The components beyond size() stay uninitialised on purpose: clearing them would cost more than the arithmetic.
  Expansion() : n_(0) {}
  Expansion(const Expansion& other) : n_(other.n_) {
    for (std::size_t i = 0; i < n_; ++i) component_[i] = other.component_[i];
  }
  Expansion& operator=(const Expansion& other) {
    n_ = other.n_;
    for (std::size_t i = 0; i < n_; ++i) component_[i] = other.component_[i];
    return *this;
  }

  std::span<const double> view() const { return {component_, n_}; }
  double* data() { return component_; }
  void resize(std::size_t n) { n_ = n; }
  int sign() const { return n_ == 0 ? 0 : sign_of(component_[n_ - 1]); }

  Expansion operator-() const {
    Expansion result;
    result.n_ = n_;
    for (std::size_t i = 0; i < n_; ++i) result.component_[i] = -component_[i];
    return result;
  }

 private:
  std::size_t n_;
  double component_[N];
};

template <std::size_t N, std::size_t M>
Expansion<N + M> operator+(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<N + M> result;
  result.resize(add(a.view(), b.view(), result.data()));
  return result;
}
template <std::size_t N, std::size_t M>
Expansion<N + M> operator-(const Expansion<N>& a, const Expansion<M>& b) {
  return a + (-b);
}
template <std::size_t N, std::size_t M>
Expansion<2 * N * M> operator*(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<2 * N * M> result;
  double work[2 * N * M];
  double term[2 * N];
  result.resize(multiply(a.view(), b.view(), result.data(), work, term));
  return result;
}

/// Exact number of any length; for formulas whose worst case does not fit on the stack.
class LongExpansion {
 public:
  LongExpansion() = default;
  explicit LongExpansion(std::span<const double> components) : component_(components.begin(), components.end()) {}

  std::span<const double> view() const { return component_; }
  int sign() const { return component_.empty() ? 0 : sign_of(component_.back()); }

  LongExpansion operator-() const {
    LongExpansion result = *this;
    for (double& c : result.component_) c = -c;
    return result;
  }
  friend LongExpansion operator+(const LongExpansion& a, const LongExpansion& b) {
    LongExpansion result;
    result.component_.resize(a.component_.size() + b.component_.size());
    result.component_.resize(add(a.component_, b.component_, result.component_.data()));
    return result;
  }
  friend LongExpansion operator-(const LongExpansion& a, const LongExpansion& b) { return a + (-b); }
  friend LongExpansion operator*(const LongExpansion& a, const LongExpansion& b) {
    LongExpansion result;
    const std::size_t n = 2 * a.component_.size() * b.component_.size();
    std::vector<double> work(n);
    std::vector<double> term(2 * a.component_.size());
    result.component_.resize(n);
    result.component_.resize(multiply(a.component_, b.component_, result.component_.data(), work.data(), term.data()));
    return result;
  }

 private:
  std::vector<double> component_;
};

/// A computed value with the sum of the absolute values of its terms.
/// Error rule: when every term of the final sum carries at most k roundings (one for each difference of input coordinates in it, as
/// |(x - y) - fl(x - y)| <= u |fl(x - y)|; one for each product; one for each addition that it passes through), then
///   |value - exact| <= k u / (1 - k u) * (exact sum of absolute terms)        (Higham 2002, lemma 3.1)
/// and the computed `size` is at most k u / (1 + k u) short of that sum; for k <= 30 the bound (k + 1) u size covers both.
struct Bounded {
  double value;
  double size;

  /// Returns the sign if it is certain, with k roundings for each term; 2 if not. If size == 0, all terms are zero and so is the value.
  int sign(int k) const {
    const double bound = (k + 1) * k_unit * size;
    if (value > bound) return 1;
    if (value < -bound) return -1;
    return size == 0.0 ? 0 : 2;
  }
  friend Bounded operator+(const Bounded& a, const Bounded& b) { return {a.value + b.value, a.size + b.size}; }
  friend Bounded operator-(const Bounded& a, const Bounded& b) { return {a.value - b.value, a.size + b.size}; }
  friend Bounded operator*(const Bounded& a, const Bounded& b) { return {a.value * b.value, a.size * b.size}; }
};

/// Returns b - a as T.
template <class T>
T difference(double a, double b);
template <>
inline Bounded difference<Bounded>(double a, double b) {
  return {b - a, std::abs(b - a)};
}
template <>
inline Expansion<2> difference<Expansion<2>>(double a, double b) {
  Expansion<2> result;
  double sum;
  double error;
  two_sum(b, -a, sum, error);
  std::size_t n = 0;
  if (error != 0.0) result.data()[n++] = error;
  if (sum != 0.0) result.data()[n++] = sum;
  result.resize(n);
  return result;
}
template <>
inline LongExpansion difference<LongExpansion>(double a, double b) {
  return LongExpansion(difference<Expansion<2>>(a, b).view());
}

/// Vector with components of type T.
template <class T>
struct Triple {
  T x;
  T y;
  T z;
};

/// Returns q - p.
template <class T>
Triple<T> difference(const Vec3& p, const Vec3& q) {
  return {difference<T>(p.x, q.x), difference<T>(p.y, q.y), difference<T>(p.z, q.z)};
}
template <class T, class U>
auto cross(const Triple<T>& a, const Triple<U>& b) {
  using R = decltype(a.y * b.z - a.z * b.y);
  return Triple<R>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T, class U>
auto dot(const Triple<T>& a, const Triple<U>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T, class U>
auto operator+(const Triple<T>& a, const Triple<U>& b) {
  using R = decltype(a.x + b.x);
  return Triple<R>{a.x + b.x, a.y + b.y, a.z + b.z};
}

}  // namespace sterna::exact
