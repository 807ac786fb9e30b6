// Knot insertion, restriction and degree elevation are one operation here: a pole of a spline of degree p on knots k is the blossom (polar form)
// of the polynomial piece at p consecutive knots; a piece of lower degree is elevated by averaging its blossom over the arguments left out.
// Based on: Ramshaw, Blossoms are polar forms, CAGD 1989.
#include "geom/model/nurbs_tools.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geom/base/error.h"

namespace sterna {
namespace {

using Value = Lanes4::Value;
/// Knots of two splines that are nearer than this fraction of the domain differ only by rounding.
constexpr double k_same_knot = 1e-14;

/// Returns the blossom of the piece on [knots[span], knots[span + 1]] at `degree` arguments; pole i is poles[i * stride].
Value blossom(int degree, const std::vector<double>& knots, const Lanes4* poles, std::size_t stride, std::size_t span, std::span<const double> arguments) {
  const auto p = static_cast<std::size_t>(degree);
  Lanes4 d[k_max_degree + 1];
  for (std::size_t k = 0; k <= p; ++k) d[k] = poles[(span - p + k) * stride];
  for (std::size_t r = 1; r <= p; ++r) {
    for (std::size_t k = p; k >= r; --k) {
      const double from = knots[span - p + k], to = knots[span + k - r + 1];
      const double a = (arguments[r - 1] - from) / (to - from);
      d[k].value = (1.0 - a) * d[k - 1].value + a * d[k].value;
    }
  }
  return d[p].value;
}

/// Returns the span of the old spline that contains the middle of the support of new pole j: the blossom's arguments are near that span.
std::size_t span_near(int degree, const std::vector<double>& knots, double t) {
  const auto p = static_cast<std::size_t>(degree);
  std::size_t span = static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), t) - knots.begin());
  span = std::clamp(span, p + 1, knots.size() - p - 1) - 1;
  while (span > p && !(knots[span] < knots[span + 1])) --span;
  return span;
}

/// Converts the poles of one row to other knots of the same degree or of the next higher one.
void convert_row(int old_degree, const std::vector<double>& old_knots, const Lanes4* old_poles, std::size_t old_stride, int degree,
                 const std::vector<double>& knots, Lanes4* poles, std::size_t stride) {
  const auto q = static_cast<std::size_t>(degree);
  const std::size_t n = knots.size() - q - 1;
  for (std::size_t j = 0; j < n; ++j) {
    // The longest span below the new pole gives the smallest rounding error.
    std::size_t widest = j;
    for (std::size_t k = j; k <= j + q; ++k)
      if (knots[k + 1] - knots[k] > knots[widest + 1] - knots[widest]) widest = k;
    const std::size_t span = span_near(old_degree, old_knots, 0.5 * (knots[widest] + knots[widest + 1]));
    std::vector<double> arguments(knots.begin() + static_cast<std::ptrdiff_t>(j) + 1, knots.begin() + static_cast<std::ptrdiff_t>(j + q) + 1);
    if (degree == old_degree) {
      poles[j * stride].value = blossom(degree, old_knots, old_poles, old_stride, span, arguments);
      continue;
    }
    // Take the mean over the omitted argument.
    Value sum{};
    for (std::size_t out = 0; out < q; ++out) {
      std::vector<double> some = arguments;
      some.erase(some.begin() + static_cast<std::ptrdiff_t>(out));
      sum += blossom(old_degree, old_knots, old_poles, old_stride, span, some);
    }
    poles[j * stride].value = sum / static_cast<double>(q);
  }
}

void split_weights(const std::vector<Lanes4>& poles, bool is_rational, std::vector<Point>& points, std::vector<double>& weights) {
  points.resize(poles.size());
  weights.assign(is_rational ? poles.size() : 0, 1.0);
  for (std::size_t i = 0; i < poles.size(); ++i) {
    const Value& p = poles[i].value;
    points[i] = {p[0], p[1], p[2]};
    if (!is_rational) continue;
    weights[i] = p[3];
    points[i] = points[i] / p[3];
  }
}

}  // namespace

std::vector<Lanes4> weighted_poles(const std::vector<Point>& poles, const std::vector<double>& weights, std::size_t n, std::string_view attempted) {
  if (poles.size() != n) throw_bad_argument(attempted, std::to_string(poles.size()) + " poles, but knots and degree require " + std::to_string(n));
  if (!weights.empty() && weights.size() != n) throw_bad_argument(attempted, std::to_string(weights.size()) + " weights for " + std::to_string(n) + " poles");
  std::vector<Lanes4> result(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double w = weights.empty() ? 1.0 : weights[i];
    if (!(w > 0.0) || !std::isfinite(w)) throw_bad_argument(attempted, "weight " + std::to_string(i) + " is not positive");
    if (!is_finite(poles[i])) throw_bad_argument(attempted, "pole " + std::to_string(i) + " is not finite");
    result[i].value = Value{w * poles[i].x, w * poles[i].y, w * poles[i].z, w};
  }
  return result;
}

NurbsCurveForm<Point> on_knots(const NurbsCurveForm<Point>& form, int degree, const std::vector<double>& knots) {
  if (degree > form.degree + 1) return on_knots(on_knots(form, form.degree + 1, elevated_knots(form.knots, 1)), degree, knots);
  const std::vector<Lanes4> old = weighted_poles(form.poles, form.weights, form.poles.size(), "changing the knots of a NURBS curve");
  NurbsCurveForm<Point> result;
  result.degree = degree;
  result.knots = knots;
  std::vector<Lanes4> poles(knots.size() - static_cast<std::size_t>(degree) - 1);
  convert_row(form.degree, form.knots, old.data(), 1, degree, knots, poles.data(), 1);
  split_weights(poles, !form.weights.empty(), result.poles, result.weights);
  return result;
}

NurbsSurfaceForm on_knots_u(const NurbsSurfaceForm& form, int degree, const std::vector<double>& knots) {
  if (degree > form.degree_u + 1) return on_knots_u(on_knots_u(form, form.degree_u + 1, elevated_knots(form.knots_u, 1)), degree, knots);
  const std::vector<Lanes4> old = weighted_poles(form.poles, form.weights, form.poles.size(), "changing the knots of a NURBS surface");
  NurbsSurfaceForm result = form;
  result.degree_u = degree;
  result.knots_u = knots;
  result.n_u = knots.size() - static_cast<std::size_t>(degree) - 1;
  std::vector<Lanes4> poles(result.n_u * form.n_v);
  for (std::size_t j = 0; j < form.n_v; ++j) convert_row(form.degree_u, form.knots_u, old.data() + j, form.n_v, degree, knots, poles.data() + j, form.n_v);
  split_weights(poles, !form.weights.empty(), result.poles, result.weights);
  return result;
}

NurbsSurfaceForm on_knots_v(const NurbsSurfaceForm& form, int degree, const std::vector<double>& knots) {
  return exchanged(on_knots_u(exchanged(form), degree, knots));
}

std::vector<double> restricted_knots(int degree, const std::vector<double>& knots, Interval range) {
  const auto order = static_cast<std::size_t>(degree) + 1;
  std::vector<double> result(order, range.from);
  for (const double k : knots)
    if (k > range.from && k < range.to) result.push_back(k);
  result.insert(result.end(), order, range.to);
  return result;
}

std::vector<double> elevated_knots(const std::vector<double>& knots, int by) {
  std::vector<double> result;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    result.push_back(knots[i]);
    if (i + 1 == knots.size() || knots[i + 1] > knots[i]) result.insert(result.end(), static_cast<std::size_t>(by), knots[i]);
  }
  return result;
}

std::vector<double> united_knots(const std::vector<double>& a, const std::vector<double>& b) {
  const double tolerance = k_same_knot * (a.back() - a.front());
  std::vector<double> snapped = b, result;
  for (double& k : snapped) {
    const auto above = std::lower_bound(a.begin(), a.end(), k - tolerance);
    if (above != a.end() && *above <= k + tolerance) k = *above;
  }
  std::set_union(a.begin(), a.end(), snapped.begin(), snapped.end(), std::back_inserter(result));
  return result;
}

std::vector<double> stretched_knots(const std::vector<double>& knots, Interval domain) {
  const double scale = domain.length() / (knots.back() - knots.front());
  std::vector<double> result;
  for (const double k : knots) result.push_back(k == knots.front() ? domain.from : k == knots.back() ? domain.to : domain.from + scale * (k - knots.front()));
  return result;
}

NurbsCurveForm<Point> restricted(const NurbsCurveForm<Point>& form, Interval range) {
  if (range == Interval{form.knots.front(), form.knots.back()}) return form;
  return on_knots(form, form.degree, restricted_knots(form.degree, form.knots, range));
}

NurbsSurfaceForm restricted(const NurbsSurfaceForm& form, Interval range_u, Interval range_v) {
  NurbsSurfaceForm result = form;
  if (range_u != Interval{form.knots_u.front(), form.knots_u.back()})
    result = on_knots_u(result, form.degree_u, restricted_knots(form.degree_u, form.knots_u, range_u));
  if (range_v != Interval{form.knots_v.front(), form.knots_v.back()})
    result = on_knots_v(result, form.degree_v, restricted_knots(form.degree_v, form.knots_v, range_v));
  return result;
}

namespace {

std::vector<double> reversed_knots(std::vector<double> knots) {
  std::reverse(knots.begin(), knots.end());
  for (double& k : knots) k = -k;
  return knots;
}

template <class Index>
NurbsSurfaceForm reordered(const NurbsSurfaceForm& form, std::size_t n_u, std::size_t n_v, const Index& old_index) {
  NurbsSurfaceForm result = form;
  result.n_u = n_u;
  result.n_v = n_v;
  for (std::size_t i = 0; i < n_u; ++i) {
    for (std::size_t j = 0; j < n_v; ++j) {
      result.poles[i * n_v + j] = form.poles[old_index(i, j)];
      if (!form.weights.empty()) result.weights[i * n_v + j] = form.weights[old_index(i, j)];
    }
  }
  return result;
}

}  // namespace

NurbsCurveForm<Point> reversed(const NurbsCurveForm<Point>& form) {
  NurbsCurveForm<Point> result = form;
  result.knots = reversed_knots(form.knots);
  std::reverse(result.poles.begin(), result.poles.end());
  std::reverse(result.weights.begin(), result.weights.end());
  return result;
}

NurbsSurfaceForm reversed_u(const NurbsSurfaceForm& form) {
  NurbsSurfaceForm result = reordered(form, form.n_u, form.n_v, [&](std::size_t i, std::size_t j) { return (form.n_u - 1 - i) * form.n_v + j; });
  result.knots_u = reversed_knots(form.knots_u);
  return result;
}

NurbsSurfaceForm reversed_v(const NurbsSurfaceForm& form) {
  NurbsSurfaceForm result = reordered(form, form.n_u, form.n_v, [&](std::size_t i, std::size_t j) { return i * form.n_v + form.n_v - 1 - j; });
  result.knots_v = reversed_knots(form.knots_v);
  return result;
}

NurbsSurfaceForm exchanged(const NurbsSurfaceForm& form) {
  NurbsSurfaceForm result = reordered(form, form.n_v, form.n_u, [&](std::size_t i, std::size_t j) { return j * form.n_v + i; });
  std::swap(result.degree_u, result.degree_v);
  std::swap(result.knots_u, result.knots_v);
  return result;
}

}  // namespace sterna
