#include "geom/model/knot_basis.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geom/base/error.h"

namespace sterna {
namespace {

/// Number of buckets of the span table per span: the spans of uniform knots are found without any comparison.
constexpr std::size_t k_buckets_per_span = 2;
constexpr std::size_t k_max_buckets = 1 << 16;
/// Tolerance as a fraction of a bucket: rounding may put a parameter into the neighbouring bucket.
constexpr double k_bucket_margin = 1e-6;

void check_knots(int degree, const std::vector<double>& knots, std::string_view attempted) {
  if (degree < 1 || degree > k_max_degree)
    throw_bad_argument(attempted, "degree is " + std::to_string(degree) + ", must be 1 .. " + std::to_string(k_max_degree));
  const auto order = static_cast<std::size_t>(degree) + 1;
  if (knots.size() < 2 * order) throw_bad_argument(attempted, std::to_string(knots.size()) + " knots are too few for degree " + std::to_string(degree));
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i])) throw_bad_argument(attempted, "knot " + std::to_string(i) + " is not a finite number");
    if (i > 0 && knots[i] < knots[i - 1]) throw_bad_argument(attempted, "knots descend at knot " + std::to_string(i));
  }
  if (knots[order - 1] != knots.front() || knots[knots.size() - order] != knots.back())
    throw_bad_argument(attempted, "the knots are not clamped: the first and the last must appear degree + 1 = " + std::to_string(order) + " times");
  if (!(knots.front() < knots.back())) throw_bad_argument(attempted, "the knots span an interval of no length");
  std::size_t run = 1;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    run = knots[i] == knots[i - 1] ? run + 1 : 1;
    const bool is_inner = knots[i] > knots.front() && knots[i] < knots.back();
    if (run > (is_inner ? order - 1 : order))
      throw_bad_argument(attempted, "knot " + std::to_string(knots[i]) + " appears more than " + std::to_string(is_inner ? order - 1 : order) + " times");
  }
}

}  // namespace

double wrapped(double t, const Interval& domain) {
  const double length = domain.length();
  const double result = t - length * std::floor((t - domain.from) / length);
  return std::clamp(result, domain.from, domain.to);
}

KnotBasis::KnotBasis(int degree, std::vector<double> knots, bool is_periodic, std::string_view attempted)
    : degree_(degree), knots_(std::move(knots)), is_periodic_(is_periodic) {
  check_knots(degree_, knots_, attempted);
  domain_ = {knots_.front(), knots_.back()};
  const auto p = static_cast<std::size_t>(degree_);
  for (std::size_t i = p; i + p + 1 < knots_.size(); ++i) {
    if (!(knots_[i] < knots_[i + 1])) continue;
    Span span;
    span.start = knots_[i];
    span.inverse_length = 1.0 / (knots_[i + 1] - knots_[i]);
    span.first = i - p;
    if (degree_ <= 3) {
      // Makes the Taylor series at the start of the span. The recurrence gives the functions and their derivatives. The third derivative of a cubic is
      // constant, so it follows from the second derivative at both ends.
      BasisValues at_start, at_end;
      recurrence(knots_[i], span, true, at_start);
      recurrence(knots_[i + 1], span, true, at_end);
      const double h = knots_[i + 1] - knots_[i];
      for (std::size_t k = 0; k <= p; ++k) {
        span.coefficient[0].value[k] = at_start.value[k];
        span.coefficient[1].value[k] = at_start.d1[k] * h;
        span.coefficient[2].value[k] = at_start.d2[k] * (0.5 * h * h);
        span.coefficient[3].value[k] = degree_ == 3 ? (at_end.d2[k] - at_start.d2[k]) * (h * h / 6.0) : 0.0;
      }
    }
    spans_.push_back(span);
    ends_.push_back(knots_[i + 1]);
  }
  const std::size_t n = std::min(k_buckets_per_span * spans_.size(), k_max_buckets);
  buckets_per_unit_ = static_cast<double>(n) / domain_.length();
  buckets_.resize(n);
  const std::size_t last = spans_.size() - 1;
  const auto span_beyond = [&](double position) {
    const double t = domain_.from + position / buckets_per_unit_;
    return static_cast<std::uint32_t>(std::min(static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), t) - ends_.begin()), last));
  };
  for (std::size_t b = 0; b < n; ++b)
    buckets_[b] = {span_beyond(static_cast<double>(b) - k_bucket_margin), span_beyond(static_cast<double>(b) + 1.0 + k_bucket_margin)};
  buckets_.front().low = 0;
  buckets_.back().high = static_cast<std::uint32_t>(last);
}

void KnotBasis::recurrence(double t, const Span& span, bool has_derivatives, BasisValues& basis) const {
  basis.first = span.first;
  const auto p = static_cast<std::size_t>(degree_);
  const double* knot = knots_.data() + span.first;  // the span is [knot[p], knot[p + 1]]
  double left[k_max_degree + 1], right[k_max_degree + 1];
  // Lower triangle: differences of knots; upper: functions of lower degree (column j holds degree j).
  double table[k_max_degree + 1][k_max_degree + 1];
  table[0][0] = 1.0;
  for (std::size_t j = 1; j <= p; ++j) {
    left[j] = t - knot[p + 1 - j];
    right[j] = knot[p + j] - t;
    double saved = 0.0;
    for (std::size_t r = 0; r < j; ++r) {
      table[j][r] = right[r + 1] + left[j - r];
      const double part = table[r][j - 1] / table[j][r];
      table[r][j] = saved + right[r + 1] * part;
      saved = left[j - r] * part;
    }
    table[j][j] = saved;
  }
  for (std::size_t r = 0; r <= p; ++r) basis.value[r] = table[r][p];
  if (!has_derivatives) return;
  // d/dt N(r, p) = p (N(r-1, p-1) / (length of its support) - N(r, p-1) / (length of its support)), applied twice.
  const auto degree = static_cast<double>(p);
  for (std::size_t r = 0; r <= p; ++r) {
    const double before = r > 0 ? table[r - 1][p - 1] / table[p][r - 1] : 0.0;
    const double after = r < p ? table[r][p - 1] / table[p][r] : 0.0;
    basis.d1[r] = degree * (before - after);
  }
  for (std::size_t r = 0; r <= p; ++r) basis.d2[r] = 0.0;
  if (p < 2) return;
  double lower[k_max_degree + 1];  // first derivatives of the functions of degree p - 1
  for (std::size_t r = 0; r < p; ++r) {
    const double before = r > 0 ? table[r - 1][p - 2] / table[p - 1][r - 1] : 0.0;
    const double after = r + 1 < p ? table[r][p - 2] / table[p - 1][r] : 0.0;
    lower[r] = (degree - 1.0) * (before - after);
  }
  for (std::size_t r = 0; r <= p; ++r) {
    const double before = r > 0 ? lower[r - 1] / table[p][r - 1] : 0.0;
    const double after = r < p ? lower[r] / table[p][r] : 0.0;
    basis.d2[r] = degree * (before - after);
  }
}

std::vector<double> KnotBasis::breaks() const {
  std::vector<double> result;
  for (std::size_t i = 0; i < knots_.size();) {
    std::size_t end = i;
    while (end < knots_.size() && knots_[end] == knots_[i]) ++end;
    const auto multiplicity = static_cast<int>(end - i);
    if (degree_ - multiplicity < 2 && knots_[i] > domain_.from && knots_[i] < domain_.to) result.push_back(knots_[i]);
    i = end;
  }
  return result;
}

}  // namespace sterna
