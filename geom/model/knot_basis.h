// B-spline basis functions of one direction: knot span by table look-up, values and two derivatives without allocation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "geom/model/nurbs_form.h"

namespace sterna {

/// Four doubles processed as one SIMD vector; wrapped so that it can be an element of a std::vector.
struct Lanes4 {
  using Value [[gnu::vector_size(32), gnu::may_alias]] = double;
  Value value{};
};

/// Highest degree; the same limit as in OpenCASCADE, so that all splines can be exchanged.
inline constexpr int k_max_degree = 25;

/// Non-zero basis functions at a parameter: function first + k has value[k] and derivatives; k = 0 .. degree. Entries beyond are uninitialised.
struct BasisValues {
  std::size_t first;
  alignas(32) double value[k_max_degree + 3];
  alignas(32) double d1[k_max_degree + 3];
  alignas(32) double d2[k_max_degree + 3];
};

/// Basis on a clamped knot vector. Up to degree 3 the functions of each span are stored as polynomials of the local parameter (Horner in four lanes). Above
/// degree 3 they are computed by the triangular recurrence (de Boor; Piegl & Tiller, The NURBS Book, A2.3).
class KnotBasis {
 public:
  /// \pre knots as in NurbsCurveForm.
  /// \throws Error(bad_argument) that starts with `attempted`
  KnotBasis(int degree, std::vector<double> knots, bool is_periodic, std::string_view attempted);

  int degree() const { return degree_; }
  const std::vector<double>& knots() const { return knots_; }
  Interval domain() const { return domain_; }
  bool is_periodic() const { return is_periodic_; }
  std::size_t n_functions() const { return knots_.size() - static_cast<std::size_t>(degree_) - 1; }

  /// Computes the values; with `with_derivatives` also first and second derivatives. Outside the domain the end pieces are extended (periodic: t is wrapped).
  template <bool with_derivatives>
  void evaluate(double t, BasisValues& basis) const;

  /// Returns the interior knots where splines of this basis are less than twice continuously differentiable.
  std::vector<double> breaks() const;

 private:
  struct Span {
    Lanes4 coefficient[4];  ///< lane k holds the coefficients of function first + k; coefficient[i] belongs to the power i of (t - start) / length
    double start = 0.0;
    double inverse_length = 1.0;
    std::size_t first = 0;
  };
  std::size_t span_of(double t) const;
  void recurrence(double t, const Span& span, bool has_derivatives, BasisValues& basis) const;

  int degree_;
  std::vector<double> knots_;
  bool is_periodic_;
  Interval domain_;
  std::vector<double> ends_;  ///< end of each span, ascending; only spans of positive length
  struct Bucket {
    std::uint32_t low = 0, high = 0;  ///< spans that may contain a parameter of the bucket, both inclusive
  };
  std::vector<Bucket> buckets_;  ///< equal parts of the domain
  double buckets_per_unit_ = 0.0;
  std::vector<Span> spans_;
};

inline std::size_t KnotBasis::span_of(double t) const {
  const double position = (t - domain_.from) * buckets_per_unit_;
  const std::size_t n = buckets_.size();
  const std::size_t bucket = position > 0.0 ? (position < static_cast<double>(n) ? static_cast<std::size_t>(position) : n - 1) : 0;  // not a number: the first
  std::size_t low = buckets_[bucket].low, high = buckets_[bucket].high;
  while (low < high) {  // the first span that ends beyond t
    const std::size_t middle = (low + high) / 2;
    if (t < ends_[middle]) high = middle;
    else low = middle + 1;
  }
  return low;
}

/// Returns `t` moved into the domain by whole periods.
double wrapped(double t, const Interval& domain);

template <bool with_derivatives>
inline void KnotBasis::evaluate(double t, BasisValues& basis) const {
  if (is_periodic_ && !(t >= domain_.from && t <= domain_.to)) t = wrapped(t, domain_);
  const Span& span = spans_[span_of(t)];
  basis.first = span.first;
  if (degree_ > 3) return recurrence(t, span, with_derivatives, basis);
  using Value = Lanes4::Value;
  const double s = (t - span.start) * span.inverse_length;
  const Value a = span.coefficient[0].value, b = span.coefficient[1].value, c = span.coefficient[2].value, d = span.coefficient[3].value;
  *reinterpret_cast<Value*>(basis.value) = ((d * s + c) * s + b) * s + a;
  if constexpr (with_derivatives) {
    const double r = span.inverse_length;
    *reinterpret_cast<Value*>(basis.d1) = ((3.0 * s * d + 2.0 * c) * s + b) * r;
    *reinterpret_cast<Value*>(basis.d2) = (6.0 * s * d + 2.0 * c) * (r * r);
  }
}

}  // namespace sterna
