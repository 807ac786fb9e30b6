#include "geom/model/airfoil.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/model/airfoil_parts.h"
#include "geom/model/curves.h"
#include "geom/model/projection.h"
#include "geom/model/spline.h"

namespace sterna {
namespace {

constexpr int k_max_side = 2000;
/// Number of samples of a curve for measures and errors.
constexpr int k_samples = 800;

double span_of(Uv a, Uv b) { return std::hypot(b.u - a.u, b.v - a.v); }

/// Returns t of the smallest x: bisection of dx/dt in the pieces beside the point of smallest x.
double leading_edge_of(const Curve& curve, const std::vector<double>& t, std::size_t nearest) {
  double low = t[nearest - 1], high = t[nearest + 1];
  for (int k = 0; k < 200 && low < high; ++k) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (curve.derivatives(middle).first.x < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Divides [from, to] into n intervals and returns their n + 1 bounds. The integral of 1/L + sqrt(curvature/L) over the arc length is the same in each
/// interval; L is the length of the curve.
std::vector<double> spaced(const Curve& curve, double from, double to, int n) {
  std::vector<double> sum{0.0};
  const double h = (to - from) / k_samples;
  double length = 0.0;
  for (int i = 0; i < k_samples; ++i) length += norm(curve.derivatives(from + (i + 0.5) * h).first) * std::abs(h);
  for (int i = 0; i < k_samples; ++i) {
    const CurveDerivatives d = curve.derivatives(from + (i + 0.5) * h);
    const double speed = norm(d.first), curvature = norm(cross(d.first, d.second)) / std::max(speed * speed * speed, 1e-300);
    sum.push_back(sum.back() + speed * std::abs(h) * (1.0 / length + std::sqrt(curvature / length)));
  }
  std::vector<double> locations{from};
  std::size_t i = 0;
  for (int k = 1; k < n; ++k) {
    const double target = sum.back() * k / n;
    while (sum[i + 1] < target) ++i;
    locations.push_back(from + h * (static_cast<double>(i) + (target - sum[i]) / (sum[i + 1] - sum[i])));
  }
  locations.push_back(to);
  return locations;
}

}  // namespace

double Airfoil::trailing_edge_thickness() const { return span_of(points.front(), points.back()); }

AirfoilCurves airfoil_curves(const Airfoil& airfoil) {
  if (airfoil.points.size() < 5 || airfoil.leading_edge == 0 || airfoil.leading_edge + 1 >= airfoil.points.size())
    throw_bad_argument("making a spline of airfoil " + airfoil.name, std::to_string(airfoil.points.size()) + " points with the leading edge at number " +
                                                                         std::to_string(airfoil.leading_edge) + " do not run around a section");
  std::vector<Point> points;
  for (const Uv p : airfoil.points) points.push_back({p.u, 0.0, p.v});
  const std::vector<double> t = spline_parameters(points, SplineParameters::chord_length);
  AirfoilCurves curves;
  curves.around = spline_curve(points, {.tangents = SplineTangents::not_a_knot, .at = t});
  curves.leading_edge = leading_edge_of(*curves.around, t, airfoil.leading_edge);
  curves.upper = reversed(reparametrised(part_of(curves.around, {0.0, curves.leading_edge}), {0.0, 1.0}));
  curves.lower = reparametrised(part_of(curves.around, {curves.leading_edge, 1.0}), {0.0, 1.0});
  return curves;
}

AirfoilMeasures measure(const Airfoil& airfoil) {
  const AirfoilCurves curves = airfoil_curves(airfoil);
  // Heights of both sides at equal x; x rises along each side from the leading edge.
  const auto height = [](const Curve& side, double x) {
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (side.point(middle).x < x ? low : high) = middle;
    }
    return side.point(0.5 * (low + high)).z;
  };
  const double from = curves.upper->point(0.0).x, to = std::min(curves.upper->point(1.0).x, curves.lower->point(1.0).x);
  AirfoilMeasures m;
  for (int i = 1; i < k_samples; ++i) {
    const double x = from + (to - from) * 0.5 * (1.0 - std::cos(std::numbers::pi * i / k_samples));
    const double upper = height(*curves.upper, x), lower = height(*curves.lower, x);
    if (upper - lower > m.thickness) {
      m.thickness = upper - lower;
      m.thickness_at = x;
    }
    if (const double mean = 0.5 * (upper + lower); std::abs(mean) > std::abs(m.camber)) {
      m.camber = mean;
      m.camber_at = x;
    }
  }
  return m;
}

Airfoil with_trailing_edge(const Airfoil& airfoil, double thickness) {
  constexpr double k_thickest = 0.2;
  if (!(thickness >= 0.0) || !(thickness < k_thickest))
    throw_bad_argument("changing the trailing edge of airfoil " + airfoil.name,
                       "a thickness of " + number_text(thickness) + " chords, must be 0 or more and below 0.2");
  const double old = airfoil.trailing_edge_thickness();
  Airfoil result = airfoil;
  const Uv first = airfoil.points.front(), last = airfoil.points.back(), nose = airfoil.points[airfoil.leading_edge];
  const Uv middle = 0.5 * (first + last);
  if (thickness > old) {  // add linearly along the chord
    const double chord = middle.u - nose.u;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
      const double side = i < airfoil.leading_edge ? 0.5 : i > airfoil.leading_edge ? -0.5 : 0.0;
      result.points[i].v += side * (thickness - old) * std::max(0.0, result.points[i].u - nose.u) / chord;
    }
    return result;
  }
  if (!(old > 0.0)) return result;
  // Rotate each side about the leading edge, and stretch it slightly, until its end is at the required position.
  const double keep = thickness / old;
  const auto as_complex = [&](Uv p) { return std::complex<double>(p.u - nose.u, p.v - nose.v); };
  const auto turn = [&](Uv end) {
    const Uv target = middle + keep * (end - middle);
    return as_complex(target) / as_complex(end);
  };
  const std::complex<double> upper = turn(first), lower = turn(last);
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    if (i == airfoil.leading_edge) continue;
    const std::complex<double> p = as_complex(airfoil.points[i]) * (i < airfoil.leading_edge ? upper : lower);
    result.points[i] = {nose.u + p.real(), nose.v + p.imag()};
  }
  result.points.front() = middle + keep * (first - middle);
  result.points.back() = middle + keep * (last - middle);
  return result;
}

Airfoil normalized(const Airfoil& airfoil) {
  const AirfoilCurves curves = airfoil_curves(airfoil);
  const Point nose = curves.around->point(curves.leading_edge);
  const Uv middle = 0.5 * (airfoil.points.front() + airfoil.points.back());
  const double scale = 1.0 / (middle.u - nose.x);
  Airfoil result = airfoil;
  for (Uv& p : result.points) p = {scale * (p.u - nose.x), scale * (p.v - nose.z)};
  return result;
}

Repaneled repaneled(const Airfoil& airfoil, int n_side) {
  if (n_side < 5 || n_side > k_max_side)
    throw_bad_argument("repaneling airfoil " + airfoil.name, std::to_string(n_side) + " points along a side, must be 5 .. " + std::to_string(k_max_side));
  const AirfoilCurves curves = airfoil_curves(airfoil);
  std::vector<double> locations = spaced(*curves.around, 0.0, curves.leading_edge, n_side);
  const std::vector<double> lower = spaced(*curves.around, curves.leading_edge, 1.0, n_side);
  locations.insert(locations.end(), lower.begin() + 1, lower.end());
  Repaneled result;
  result.airfoil.name = airfoil.name;
  for (const double t : locations) {
    const Point p = curves.around->point(t);
    result.airfoil.points.push_back({p.x, p.z});
  }
  result.airfoil.leading_edge = static_cast<std::size_t>(n_side);
  const CurveProjector projector(airfoil_curves(result.airfoil).around);
  for (int i = 0; i <= k_samples; ++i)
    result.error = std::max(result.error, projector.nearest(curves.around->point(static_cast<double>(i) / k_samples)).distance);
  return result;
}

Repaneled repaneled_within(const Airfoil& airfoil, double tolerance) {
  if (!(tolerance > 0.0)) throw_bad_argument("repaneling airfoil " + airfoil.name, "the tolerance is " + number_text(tolerance) + " chords, must be positive");
  constexpr int k_fewest = 8;
  for (int n = k_fewest; n <= k_max_side; n += std::max(1, n / 8)) {
    Repaneled result = repaneled(airfoil, n);
    if (result.error <= tolerance) return result;
  }
  throw_bad_argument("repaneling airfoil " + airfoil.name,
                     "an error of " + number_text(tolerance) + " chords is not reached with " + std::to_string(k_max_side) + " points along a side");
}

}  // namespace sterna
