// Splines are computed row by row of points in one direction: parameters, pieces between corners, tangents at the points, poles.
#include "geom/model/spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"

namespace sterna {
namespace {

constexpr std::string_view k_curve = "making a spline curve";
constexpr std::string_view k_surface = "making a spline surface";
/// Neighbours closer than this fraction of the total length coincide: parameters could not distinguish them.
constexpr double k_coincident = 1e-12;
/// Differences of slopes below this fraction of the slopes are rounding, not bends (Akima's weights).
constexpr double k_straight = 1e-10;
/// A seam closes if its ends are closer than this fraction of the total length.
constexpr double k_closed = 1e-9;

bool is_smooth(SplineTangents t) {
  return t == SplineTangents::natural || t == SplineTangents::clamped || t == SplineTangents::not_a_knot || t == SplineTangents::periodic;
}
bool is_closed(const SplineOptions& o) {
  return o.tangents == SplineTangents::periodic || (o.is_closed && (o.tangents == SplineTangents::akima || o.tangents == SplineTangents::bessel));
}
int degree_of(const SplineOptions& o) { return o.tangents == SplineTangents::linear ? 1 : 3; }

double step_length(double distance, SplineParameters kind) {
  switch (kind) {
    case SplineParameters::uniform: return 1.0;
    case SplineParameters::chord_length: return distance;
    case SplineParameters::centripetal: return std::sqrt(distance);
  }
  return distance;
}

/// Returns the cumulative sum of steps scaled to [0, 1].
std::vector<double> scaled_sum(const std::vector<double>& steps) {
  std::vector<double> t(steps.size() + 1, 0.0);
  for (std::size_t i = 0; i < steps.size(); ++i) t[i + 1] = t[i] + steps[i];
  const double total = t.back();
  for (double& x : t) x /= total;
  t.back() = 1.0;
  return t;
}

void check_options(const SplineOptions& o, std::size_t n, std::size_t n_rows, std::string_view attempted) {
  if (n < 2) throw_bad_argument(attempted, std::to_string(n) + " points in a direction, at least 2 are needed");
  if (!o.at.empty()) {
    if (o.at.size() != n) throw_bad_argument(attempted, std::to_string(o.at.size()) + " parameters for " + std::to_string(n) + " points");
    for (std::size_t i = 0; i < n; ++i)
      if (!std::isfinite(o.at[i]) || (i > 0 && !(o.at[i] > o.at[i - 1])))
        throw_bad_argument(attempted, "the parameters are not in ascending order at point " + std::to_string(i));
  }
  if (!o.start_tangents.empty() && o.start_tangents.size() != n_rows)
    throw_bad_argument(attempted, std::to_string(o.start_tangents.size()) + " start tangents for " + std::to_string(n_rows) + " rows");
  if (!o.end_tangents.empty() && o.end_tangents.size() != n_rows)
    throw_bad_argument(attempted, std::to_string(o.end_tangents.size()) + " end tangents for " + std::to_string(n_rows) + " rows");
  if (o.tangents != SplineTangents::clamped && !(o.start_tangents.empty() && o.end_tangents.empty()))
    throw_bad_argument(attempted, "end tangents are given, but the tangents are not `clamped`");
  for (std::size_t k = 0; k < o.corners.size(); ++k) {
    const std::size_t c = o.corners[k];
    if (c == 0 || c + 1 >= n || (k > 0 && c <= o.corners[k - 1]))
      throw_bad_argument(attempted, "corner " + std::to_string(c) + " is not an inner point (1 .. " + std::to_string(n - 2) + ") or not in ascending order");
  }
  if (is_closed(o) && !o.corners.empty())
    throw_bad_argument(attempted, "a closed smooth spline cannot have corners; begin the spline at a corner and leave it open");
  if (is_closed(o) && n < 4)
    throw_bad_argument(attempted, "a closed spline of " + std::to_string(n) + " points, at least 4 are needed (the last repeats the first)");
}

// ---------------------------------------------------------------- tangents of one piece

using Points = std::vector<Point>;
using Tangents = std::vector<Vec3>;
using Numbers = std::vector<double>;

Tangents slopes_of(const Points& p, const Numbers& t) {
  Tangents d;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) d.push_back((p[i + 1] - p[i]) / (t[i + 1] - t[i]));
  return d;
}

/// Solves a tridiagonal system with any number of right-hand sides of vectors; no pivoting is needed for spline systems.
void solve_tridiagonal(const Numbers& below, Numbers diagonal, const Numbers& above, Tangents& x) {
  const std::size_t n = diagonal.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double w = below[i] / diagonal[i - 1];
    diagonal[i] -= w * above[i - 1];
    x[i] -= w * x[i - 1];
  }
  x[n - 1] = x[n - 1] / diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) x[i] = (x[i] - above[i] * x[i + 1]) / diagonal[i];
}

/// Tangents for continuous second derivatives: h_i m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_(i-1) m_(i+1) = 3 (h_i d_(i-1) + h_(i-1) d_i).
struct EndTangents {
  const Vec3* start = nullptr;  ///< nullptr: natural
  const Vec3* end = nullptr;
};
Tangents open_smooth_tangents(const Points& p, const Numbers& t, bool is_not_a_knot, const EndTangents& ends) {
  const std::size_t n = p.size();
  const Tangents d = slopes_of(p, t);
  const auto h = [&](std::size_t i) { return t[i + 1] - t[i]; };
  if (is_not_a_knot && n == 3) {  // three points: the parabola
    const Vec3 middle = (h(1) * d[0] + h(0) * d[1]) / (h(0) + h(1));
    return {2.0 * d[0] - middle, middle, 2.0 * d[1] - middle};
  }
  if (is_not_a_knot && n == 2) return {d[0], d[0]};
  Numbers below(n, 0.0), diagonal(n, 1.0), above(n, 0.0);
  Tangents m(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    below[i] = h(i);
    diagonal[i] = 2.0 * (h(i - 1) + h(i));
    above[i] = h(i - 1);
    m[i] = 3.0 * (h(i) * d[i - 1] + h(i - 1) * d[i]);
  }
  if (is_not_a_knot) {
    const double first = h(0) + h(1), last = h(n - 2) + h(n - 3);
    diagonal[0] = h(1);
    above[0] = first;
    m[0] = ((h(0) + 2.0 * first) * h(1) * d[0] + h(0) * h(0) * d[1]) / first;
    diagonal[n - 1] = h(n - 3);
    below[n - 1] = last;
    m[n - 1] = ((h(n - 2) + 2.0 * last) * h(n - 3) * d[n - 2] + h(n - 2) * h(n - 2) * d[n - 3]) / last;
  } else {
    diagonal[0] = ends.start ? 1.0 : 2.0;
    above[0] = ends.start ? 0.0 : 1.0;
    m[0] = ends.start ? *ends.start : 3.0 * d[0];
    diagonal[n - 1] = ends.end ? 1.0 : 2.0;
    below[n - 1] = ends.end ? 0.0 : 1.0;
    m[n - 1] = ends.end ? *ends.end : 3.0 * d[n - 2];
  }
  solve_tridiagonal(below, diagonal, above, m);
  return m;
}

/// Solves the same equations on a closed curve: n - 1 unknowns in a cyclic system, by the Sherman-Morrison formula.
Tangents periodic_tangents(const Points& p, const Numbers& t) {
  const std::size_t n = p.size() - 1;
  const Tangents d = slopes_of(p, t);
  const auto h = [&](std::size_t i) { return t[i + 1] - t[i]; };
  Numbers below(n), diagonal(n), above(n);
  Tangents m(n), correction(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i == 0 ? n - 1 : i - 1;
    below[i] = h(i);
    diagonal[i] = 2.0 * (h(before) + h(i));
    above[i] = h(before);
    m[i] = 3.0 * (h(i) * d[before] + h(before) * d[i]);
  }
  const double gamma = -diagonal[0];
  const double corner_top = below[0], corner_bottom = above[n - 1];  // couple the first unknown with the last
  diagonal[0] -= gamma;
  diagonal[n - 1] -= corner_top * corner_bottom / gamma;
  correction[0] = {gamma, 0.0, 0.0};
  correction[n - 1] = {corner_bottom, 0.0, 0.0};
  solve_tridiagonal(below, diagonal, above, m);
  solve_tridiagonal(below, diagonal, above, correction);
  const double scale = 1.0 + correction[0].x + corner_top * correction[n - 1].x / gamma;
  const Vec3 factor = (m[0] + (corner_top / gamma) * m[n - 1]) / scale;
  for (std::size_t i = 0; i < n; ++i) m[i] -= correction[i].x * factor;
  m.push_back(m.front());
  return m;
}

/// Returns Akima's or Bessel's tangents from the slopes beside each point.
Tangents local_tangents(const Points& p, const Numbers& t, bool is_akima, bool closed) {
  const std::size_t n = p.size();
  const Tangents inner = slopes_of(p, t);
  if (n == 2) return {inner[0], inner[0]};
  // Slope of segment i is d[i + 2]. There are two more slopes at each end: those of the other end (closed), or extrapolated ones (Akima).
  Tangents d(n + 3);
  std::copy(inner.begin(), inner.end(), d.begin() + 2);
  if (closed) {
    d[1] = inner[n - 2];
    d[0] = inner[n - 3];
    d[n + 1] = inner[0];
    d[n + 2] = inner[1];
  } else {
    d[1] = 2.0 * d[2] - d[3];
    d[0] = 2.0 * d[1] - d[2];
    d[n + 1] = 2.0 * d[n] - d[n - 1];
    d[n + 2] = 2.0 * d[n + 1] - d[n];
  }
  const auto h = [&](std::size_t i) { return t[i + 1] - t[i]; };
  Tangents m(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &before = d[i + 1], &after = d[i + 2];
    if (is_akima) {
      const double w_before = norm(d[i + 3] - after), w_after = norm(before - d[i]);
      const bool is_between_lines = w_before + w_after <= k_straight * (norm(before) + norm(after));
      m[i] = is_between_lines ? 0.5 * (before + after) : (w_before * before + w_after * after) / (w_before + w_after);
    } else if (i > 0 && i + 1 < n) {
      m[i] = (h(i) * before + h(i - 1) * after) / (h(i - 1) + h(i));
    } else if (closed) {
      m[i] = (h(0) * before + h(n - 2) * after) / (h(n - 2) + h(0));
    }
  }
  if (!is_akima && !closed) {
    m[0] = 2.0 * inner[0] - m[1];
    m[n - 1] = 2.0 * inner[n - 2] - m[n - 2];
  }
  return m;
}

/// Returns Fritsch and Butland's slope at an inner point (SIAM J. Sci. Stat. Comput. 5, 1984): zero at an extremum, else the weighted harmonic mean of both
/// slopes.
double monotone_slope(double h_before, double h_after, double before, double after) {
  if (!(before * after > 0.0)) return 0.0;
  const double w_before = h_before + 2.0 * h_after, w_after = 2.0 * h_before + h_after;
  return (w_before + w_after) / (w_before / before + w_after / after);
}

/// Returns the slope at an end: that of the parabola through three points, limited so that the first segment is monotone.
double monotone_end(double h_first, double h_second, double first, double second) {
  const double slope = ((2.0 * h_first + h_second) * first - h_first * second) / (h_first + h_second);
  if (!(slope * first > 0.0)) return 0.0;
  return first * second <= 0.0 && std::abs(slope) > 3.0 * std::abs(first) ? 3.0 * first : slope;
}

Tangents monotone_tangents(const Points& p, const Numbers& t) {
  const std::size_t n = p.size();
  const Tangents d = slopes_of(p, t);
  if (n == 2) return {d[0], d[0]};
  const auto h = [&](std::size_t i) { return t[i + 1] - t[i]; };
  Tangents m(n);
  for (double Vec3::*c : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    m[0].*c = monotone_end(h(0), h(1), d[0].*c, d[1].*c);
    for (std::size_t i = 1; i + 1 < n; ++i) m[i].*c = monotone_slope(h(i - 1), h(i), d[i - 1].*c, d[i].*c);
    m[n - 1].*c = monotone_end(h(n - 2), h(n - 3), d[n - 2].*c, d[n - 3].*c);
  }
  return m;
}

Tangents tangents_of(const Points& p, const Numbers& t, const SplineOptions& o, const EndTangents& ends) {
  switch (o.tangents) {
    case SplineTangents::natural:
    case SplineTangents::clamped: return open_smooth_tangents(p, t, false, ends);
    case SplineTangents::not_a_knot: return open_smooth_tangents(p, t, true, {});
    case SplineTangents::periodic: return periodic_tangents(p, t);
    case SplineTangents::akima: return local_tangents(p, t, true, is_closed(o));
    case SplineTangents::bessel: return local_tangents(p, t, false, is_closed(o));
    case SplineTangents::monotone: return monotone_tangents(p, t);
    case SplineTangents::linear: break;
  }
  return slopes_of(p, t);
}

// ---------------------------------------------------------------- one row

/// Returns the first and last point of each piece between corners.
std::vector<std::array<std::size_t, 2>> pieces_of(const SplineOptions& o, std::size_t n) {
  std::vector<std::array<std::size_t, 2>> pieces;
  std::size_t from = 0;
  for (const std::size_t corner : o.corners) {
    pieces.push_back({from, corner});
    from = corner;
  }
  pieces.push_back({from, n - 1});
  return pieces;
}

std::vector<double> knots_of(const Numbers& t, const SplineOptions& o) {
  if (o.tangents == SplineTangents::linear) {
    std::vector<double> knots(t);
    knots.insert(knots.begin(), t.front());
    knots.push_back(t.back());
    return knots;
  }
  std::vector<double> knots(4, t.front());
  for (std::size_t i = 1; i + 1 < t.size(); ++i) {
    const bool is_corner = std::binary_search(o.corners.begin(), o.corners.end(), i);
    knots.insert(knots.end(), is_corner ? 3 : is_smooth(o.tangents) ? 1 : 2, t[i]);
  }
  knots.insert(knots.end(), 4, t.back());
  return knots;
}

void append_piece(const Points& p, const Numbers& t, const SplineOptions& o, const EndTangents& ends, Points& poles) {
  const Tangents m = tangents_of(p, t, o, ends);
  const auto h = [&](std::size_t i) { return t[i + 1] - t[i]; };
  const auto second = [&](std::size_t i) { return p[i] + h(i) / 3.0 * m[i]; };  // Bezier points of segment i
  const auto third = [&](std::size_t i) { return p[i + 1] - h(i) / 3.0 * m[i + 1]; };
  const std::size_t last = p.size() - 1;
  poles.push_back(second(0));
  for (std::size_t i = 1; i < last; ++i) {
    if (!is_smooth(o.tangents)) {
      poles.push_back(third(i - 1));
      poles.push_back(second(i));
    } else if (h(i) >= h(i - 1)) {  // blossom at (t_(i-1), t_i, t_(i+1)), computed from the longer segment for a smaller rounding error
      poles.push_back(second(i) + (t[i - 1] - t[i]) / h(i) * (third(i) - second(i)));
    } else {
      poles.push_back(second(i - 1) + (t[i + 1] - t[i - 1]) / h(i - 1) * (third(i - 1) - second(i - 1)));
    }
  }
  poles.push_back(third(last - 1));
  poles.push_back(p[last]);
}

/// Returns the poles of the spline through one row of points.
Points poles_of(const Points& p, const Numbers& t, const SplineOptions& o, const EndTangents& ends) {
  if (o.tangents == SplineTangents::linear) return p;
  Points poles{p.front()};
  for (const auto& [from, to] : pieces_of(o, p.size())) {
    const auto first = static_cast<std::ptrdiff_t>(from), beyond = static_cast<std::ptrdiff_t>(to) + 1;
    const EndTangents piece_ends{from == 0 ? ends.start : nullptr, to + 1 == p.size() ? ends.end : nullptr};
    append_piece({p.begin() + first, p.begin() + beyond}, {t.begin() + first, t.begin() + beyond}, o, piece_ends, poles);
  }
  return poles;
}

EndTangents ends_of(const SplineOptions& o, std::size_t row) {
  return {o.start_tangents.empty() ? nullptr : &o.start_tangents[row], o.end_tangents.empty() ? nullptr : &o.end_tangents[row]};
}

void check_seam(const Point& first, const Point& last, double length, std::string_view attempted) {
  if (distance(first, last) > k_closed * length)
    throw_bad_argument(attempted,
                       "the last point of a closed spline must repeat the first point: the two points are " + number_text(distance(first, last)) + " m apart",
                       {{first, "first"}, {last, "last"}});
}

// ---------------------------------------------------------------- rows of a grid

/// Returns the mean parameters of `n_rows` rows of n points; get(i, row).
template <class Get>
Numbers mean_parameters(std::size_t n, std::size_t n_rows, const Get& get, SplineParameters kind) {
  Numbers length(n_rows, 0.0);
  for (std::size_t row = 0; row < n_rows; ++row)
    for (std::size_t i = 0; i + 1 < n; ++i) length[row] += distance(get(i, row), get(i + 1, row));
  const double longest = *std::max_element(length.begin(), length.end());
  if (!(longest > 0.0)) throw_bad_argument(k_surface, "all points of a direction coincide", {{get(0, 0), "here"}});
  Numbers mean(n - 1, 0.0);
  for (std::size_t row = 0; row < n_rows; ++row) {
    if (length[row] <= k_coincident * longest) continue;
    Numbers steps;
    double total = 0.0;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      steps.push_back(step_length(distance(get(i, row), get(i + 1, row)), kind));
      total += steps.back();
    }
    for (std::size_t i = 0; i + 1 < n; ++i) mean[i] += steps[i] / total;
  }
  double total = 0.0;
  for (const double step : mean) total += step;
  for (std::size_t i = 0; i + 1 < n; ++i)
    if (mean[i] <= k_coincident * total)
      throw_bad_argument(k_surface, "rows " + std::to_string(i) + " and " + std::to_string(i + 1) + " of points coincide",
                         {{get(i, 0), "first point of the row"}});
  return scaled_sum(mean);
}

}  // namespace

std::vector<double> spline_parameters(std::span<const Point> points, SplineParameters kind) {
  std::vector<double> steps;
  double total = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    steps.push_back(distance(points[i], points[i + 1]));
    total += steps.back();
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!(steps[i] > k_coincident * total) && kind != SplineParameters::uniform)
      throw_bad_argument(k_curve, "points " + std::to_string(i) + " and " + std::to_string(i + 1) + " coincide", {{points[i], "point " + std::to_string(i)}});
    steps[i] = step_length(steps[i], kind);
  }
  return scaled_sum(steps);
}

NurbsCurveForm<Point> spline_form(std::span<const Point> points, const SplineOptions& options) {
  check_options(options, points.size(), 1, k_curve);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_finite(points[i])) throw_bad_argument(k_curve, "point " + std::to_string(i) + " is not finite");
  Points p(points.begin(), points.end());
  const Numbers t = options.at.empty() ? spline_parameters(points, options.parameters) : options.at;
  if (is_closed(options)) {
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < p.size(); ++i) length += distance(p[i], p[i + 1]);
    check_seam(p.front(), p.back(), length, k_curve);
    p.back() = p.front();
  }
  return {degree_of(options), knots_of(t, options), poles_of(p, t, options, ends_of(options, 0)), {}};
}

CurvePtr spline_curve(std::span<const Point> points, const SplineOptions& options) {
  return std::make_shared<NurbsCurve>(spline_form(points, options), is_closed(options));
}

NurbsSurfaceForm spline_surface_form(const PointGrid& grid, const SplineOptions& u, const SplineOptions& v) {
  if (grid.points.size() != grid.n_u * grid.n_v)
    throw_bad_argument(k_surface, std::to_string(grid.points.size()) + " points for a grid of " + std::to_string(grid.n_u) + " x " + std::to_string(grid.n_v));
  check_options(u, grid.n_u, grid.n_v, k_surface);
  check_options(v, grid.n_v, grid.n_u, k_surface);
  for (std::size_t i = 0; i < grid.points.size(); ++i)
    if (!is_finite(grid.points[i]))
      throw_bad_argument(k_surface, "point (" + std::to_string(i / grid.n_v) + ", " + std::to_string(i % grid.n_v) + ") is not finite");
  const Numbers tu = !u.at.empty() ? u.at
                                   : mean_parameters(
                                         grid.n_u, grid.n_v, [&](std::size_t i, std::size_t row) { return grid(i, row); }, u.parameters);
  const Numbers tv = !v.at.empty() ? v.at
                                   : mean_parameters(
                                         grid.n_v, grid.n_u, [&](std::size_t j, std::size_t row) { return grid(row, j); }, v.parameters);
  double extent = 0.0;
  for (const Point& p : grid.points) extent = std::max(extent, distance(p, grid.points.front()));

  NurbsSurfaceForm form;
  form.degree_u = degree_of(u);
  form.degree_v = degree_of(v);
  form.knots_u = knots_of(tu, u);
  form.knots_v = knots_of(tv, v);
  form.n_u = form.knots_u.size() - static_cast<std::size_t>(form.degree_u) - 1;
  form.n_v = form.knots_v.size() - static_cast<std::size_t>(form.degree_v) - 1;

  std::vector<Points> columns;  // poles along u of each column of points
  for (std::size_t j = 0; j < grid.n_v; ++j) {
    Points p;
    for (std::size_t i = 0; i < grid.n_u; ++i) p.push_back(grid(i, j));
    if (is_closed(u)) {
      check_seam(p.front(), p.back(), extent, k_surface);
      p.back() = p.front();
    }
    columns.push_back(poles_of(p, tu, u, ends_of(u, j)));
  }
  // The end tangents along v belong to rows of points, but rows of poles are required. The tangents are therefore splined along u in the same way as the
  // points, without twist where u is clamped.
  const Vec3 none{};
  const auto splined_tangents = [&](const std::vector<Vec3>& tangents) {
    return tangents.empty() ? Points{} : poles_of(tangents, tu, u, u.tangents == SplineTangents::clamped ? EndTangents{&none, &none} : EndTangents{});
  };
  const Points start = splined_tangents(v.start_tangents), end = splined_tangents(v.end_tangents);
  form.poles.resize(form.n_u * form.n_v);
  for (std::size_t i = 0; i < form.n_u; ++i) {
    Points p;
    for (std::size_t j = 0; j < grid.n_v; ++j) p.push_back(columns[j][i]);
    if (is_closed(v)) {
      check_seam(p.front(), p.back(), extent, k_surface);
      p.back() = p.front();
    }
    const Points poles = poles_of(p, tv, v, {start.empty() ? nullptr : &start[i], end.empty() ? nullptr : &end[i]});
    std::copy(poles.begin(), poles.end(), form.poles.begin() + static_cast<std::ptrdiff_t>(i * form.n_v));
  }
  return form;
}

SurfacePtr spline_surface(const PointGrid& grid, const SplineOptions& u, const SplineOptions& v) {
  const int n_cubic = (degree_of(u) == 3 ? 1 : 0) + (degree_of(v) == 3 ? 1 : 0);
  return std::make_shared<NurbsSurface>(spline_surface_form(grid, u, v), is_closed(u), is_closed(v),
                                        n_cubic == 2   ? "bicubic spline"
                                        : n_cubic == 1 ? "linear-cubic spline"
                                                       : "bilinear spline");
}

}  // namespace sterna
