// Start with a few stations in both directions; spline them; compare at points between; split the intervals in the direction that causes the error; repeat
// until no point is worse than the tolerance.
#include "geom/model/sampled.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/model/spline.h"

namespace sterna {
namespace {

constexpr int k_first_intervals = 4;  ///< between breaks
/// Comparison points within an interval; not symmetric, so that errors of periodic functions are not missed.
constexpr std::array<double, 2> k_between = {0.31, 0.5};
/// Allowed gap of seams, relative to the tolerance.
constexpr double k_seam = 0.1;

[[noreturn]] void refuse_sampling(std::string problem, std::vector<ErrorLocation> locations = {}, std::string hint = {}) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "sampling a function to a spline",
               .problem = std::move(problem),
               .locations = std::move(locations),
               .hint = std::move(hint)});
}

std::string text_of(Uv at) { return "(u, v) = (" + number_text(at.u) + ", " + number_text(at.v) + ")"; }

/// Stations of one direction and the kinks among them.
struct Stations {
  std::vector<double> at;
  std::vector<double> breaks;
  bool is_periodic = false;

  Stations(Interval range, const std::vector<double>& kinks, bool periodic) : breaks(kinks), is_periodic(periodic) {
    if (!std::isfinite(range.from) || !std::isfinite(range.to) || !(range.from < range.to))
      refuse_sampling("the parameter range [" + number_text(range.from) + ", " + number_text(range.to) + "] has no length");
    std::vector<double> stops{range.from};
    for (const double b : breaks) {
      if (!(b > stops.back()) || !(b < range.to))
        refuse_sampling("break " + number_text(b) + " is outside the range, or the breaks are not in ascending order");
      stops.push_back(b);
    }
    stops.push_back(range.to);
    for (std::size_t i = 0; i + 1 < stops.size(); ++i)
      for (int k = 0; k < k_first_intervals; ++k) at.push_back(stops[i] + (stops[i + 1] - stops[i]) * k / k_first_intervals);
    at.push_back(range.to);
  }

  std::size_t n_intervals() const { return at.size() - 1; }
  double between(std::size_t i, double share) const { return at[i] + share * (at[i + 1] - at[i]); }

  SplineOptions spline() const {
    // A closed spline is smooth everywhere; with kinks it is open, and the seam is an additional kink.
    const bool is_closed = is_periodic && breaks.empty();
    SplineOptions o{.tangents = is_closed ? SplineTangents::periodic : SplineTangents::not_a_knot, .at = at};
    for (const double b : breaks) o.corners.push_back(static_cast<std::size_t>(std::lower_bound(at.begin(), at.end(), b) - at.begin()));
    return o;
  }

  /// Inserts stations in the middle of marked intervals.
  void split(const std::vector<char>& is_marked) {
    std::vector<double> result;
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      result.push_back(at[i]);
      if (is_marked[i]) result.push_back(0.5 * (at[i] + at[i + 1]));
    }
    result.push_back(at.back());
    at = std::move(result);
  }
};

/// Caches the values of the function.
class Function {
 public:
  explicit Function(const std::function<Point(Uv)>& f) : f_(f) {}
  const Point& operator()(Uv at) {
    const auto [location, is_new] = values_.try_emplace(std::array{at.u, at.v});
    if (is_new) {
      location->second = f_(at);
      if (!is_finite(location->second)) refuse_sampling("the function returns numbers that are not finite at " + text_of(at));
    }
    return location->second;
  }

 private:
  const std::function<Point(Uv)>& f_;
  std::map<std::array<double, 2>, Point> values_;
};

void check_options(const SamplingOptions& o) {
  if (!(o.tolerance > 0.0) || !std::isfinite(o.tolerance)) refuse_sampling("the tolerance is " + number_text(o.tolerance) + " m, must be positive");
  if (o.max_intervals < k_first_intervals) refuse_sampling("max_intervals is " + std::to_string(o.max_intervals) + ", must be 4 or more");
}

[[noreturn]] void fail_to_reach(double error, double tolerance, int max_intervals, const Point& location, const std::string& where) {
  refuse_sampling("the error is still " + number_text(error) + " m with " + std::to_string(max_intervals) + " intervals along a direction, the tolerance is " +
                      number_text(tolerance) + " m",
                  {{location, where}},
                  "if the function has a kink or a step there, give its parameter in breaks; or allow a larger tolerance or more intervals");
}

struct Worst {
  double error = 0.0;
  Uv at;
  Point point;
  void add(double e, Uv a, const Point& p) {
    if (e > error) *this = {e, a, p};
  }
};

NurbsSurfaceForm spline_of(Function& f, const Stations& u, const Stations& v) {
  PointGrid grid{u.at.size(), v.at.size(), {}};
  for (const double a : u.at)
    for (const double b : v.at) grid.points.push_back(f({a, b}));
  // Both ends of a period are the same point to the bit.
  if (u.is_periodic)
    for (std::size_t j = 0; j < grid.n_v; ++j) grid.points[(grid.n_u - 1) * grid.n_v + j] = grid.points[j];
  if (v.is_periodic)
    for (std::size_t i = 0; i < grid.n_u; ++i) grid.points[i * grid.n_v + grid.n_v - 1] = grid.points[i * grid.n_v];
  return spline_surface_form(grid, u.spline(), v.spline());
}

void check_seams(Function& f, const Stations& u, const Stations& v, double tolerance) {
  const auto check = [&](Uv a, Uv b) {
    if (const double gap = distance(f(a), f(b)); gap > k_seam * tolerance)
      refuse_sampling("the function is declared periodic, but its ends are " + number_text(gap) + " m apart at " + text_of(a),
                      {{f(a), "start"}, {f(b), "end"}});
  };
  if (u.is_periodic)
    for (const double b : v.at) check({u.at.front(), b}, {u.at.back(), b});
  if (v.is_periodic)
    for (const double a : u.at) check({a, v.at.front()}, {a, v.at.back()});
}

}  // namespace

SampledSurface sample_surface(const std::function<Point(Uv)>& function, const ParameterBox& box, const SamplingOptions& options) {
  check_options(options);
  Function f(function);
  Stations u(box.u, options.breaks_u, options.is_periodic_u), v(box.v, options.breaks_v, options.is_periodic_v);
  while (true) {
    check_seams(f, u, v, options.tolerance);
    auto surface = std::make_shared<NurbsSurface>(spline_of(f, u, v), u.is_periodic, v.is_periodic, "bicubic spline");
    Worst worst;
    const auto error_at = [&](Uv at) {
      const double error = distance(surface->point(at), f(at));
      worst.add(error, at, f(at));
      return error;
    };
    std::vector<char> split_u(u.n_intervals(), 0), split_v(v.n_intervals(), 0);
    // Errors on the station lines of one direction show which direction must be split.
    for (std::size_t i = 0; i < u.n_intervals(); ++i)
      for (const double b : v.at)
        for (const double share : k_between)
          if (error_at({u.between(i, share), b}) > options.tolerance) split_u[i] = 1;
    for (std::size_t j = 0; j < v.n_intervals(); ++j)
      for (const double a : u.at)
        for (const double share : k_between)
          if (error_at({a, v.between(j, share)}) > options.tolerance) split_v[j] = 1;
    // Test the inside of a cell only if none of its sides exceeded the tolerance.
    for (std::size_t i = 0; i < u.n_intervals(); ++i)
      for (std::size_t j = 0; j < v.n_intervals(); ++j) {
        if (split_u[i] || split_v[j]) continue;
        bool is_bad = false;
        for (const double s : k_between)
          for (const double t : k_between) is_bad = error_at({u.between(i, s), v.between(j, t)}) > options.tolerance || is_bad;
        if (is_bad) split_u[i] = split_v[j] = 1;
      }
    if (worst.error <= options.tolerance) return {surface, worst.error, worst.at, u.at.size(), v.at.size()};
    u.split(split_u);
    v.split(split_v);
    const auto most = static_cast<std::size_t>(options.max_intervals);
    if (u.n_intervals() > most || v.n_intervals() > most) fail_to_reach(worst.error, options.tolerance, options.max_intervals, worst.point, text_of(worst.at));
  }
}

SampledSurface sample_surface(const Surface& surface, double tolerance) {
  SamplingOptions options{.tolerance = tolerance,
                          .breaks_u = surface.breaks_u(),
                          .breaks_v = surface.breaks_v(),
                          .is_periodic_u = surface.is_periodic_u(),
                          .is_periodic_v = surface.is_periodic_v()};
  const auto enough = [](const std::vector<double>& breaks) { return 4 * k_first_intervals * static_cast<int>(breaks.size() + 1); };
  options.max_intervals = std::max({options.max_intervals, enough(options.breaks_u), enough(options.breaks_v)});
  return sample_surface([&](Uv at) { return surface.point(at); }, surface.domain(), options);
}

SampledCurve sample_curve(const std::function<Point(double)>& function, Interval range, const SamplingOptions& options) {
  check_options(options);
  const std::function<Point(Uv)> along = [&](Uv at) { return function(at.u); };
  Function f(along);
  Stations t(range, options.breaks_u, options.is_periodic_u);
  if (const double gap = distance(f({range.from, 0.0}), f({range.to, 0.0})); t.is_periodic && gap > k_seam * options.tolerance)
    refuse_sampling("the function is declared periodic, but its ends are " + number_text(gap) + " m apart",
                    {{f({range.from, 0.0}), "start"}, {f({range.to, 0.0}), "end"}});
  while (true) {
    std::vector<Point> points;
    for (const double s : t.at) points.push_back(f({s, 0.0}));
    if (t.is_periodic) points.back() = points.front();
    auto curve = std::make_shared<NurbsCurve>(spline_form(points, t.spline()), t.is_periodic);
    Worst worst;
    std::vector<char> split(t.n_intervals(), 0);
    for (std::size_t i = 0; i < t.n_intervals(); ++i)
      for (const double share : {0.17, k_between[0], k_between[1], 0.83}) {
        const Uv at{t.between(i, share), 0.0};
        const double error = distance(curve->point(at.u), f(at));
        worst.add(error, at, f(at));
        if (error > options.tolerance) split[i] = 1;
      }
    if (worst.error <= options.tolerance) return {curve, worst.error, worst.at.u, t.at.size()};
    t.split(split);
    if (t.n_intervals() > static_cast<std::size_t>(options.max_intervals))
      fail_to_reach(worst.error, options.tolerance, options.max_intervals, worst.point, "t = " + number_text(worst.at.u));
  }
}

SampledCurve sample_curve(const Curve& curve, double tolerance) {
  SamplingOptions options{.tolerance = tolerance, .breaks_u = curve.breaks(), .is_periodic_u = curve.is_periodic()};
  options.max_intervals = std::max(options.max_intervals, 4 * k_first_intervals * static_cast<int>(options.breaks_u.size() + 1));
  return sample_curve([&](double t) { return curve.point(t); }, curve.domain(), options);
}

}  // namespace sterna
