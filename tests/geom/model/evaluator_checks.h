// Checks that hold for every curve and surface: derivatives against central differences, the exact NURBS form, batch against single points.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"

namespace sterna::test {

/// Returns the largest distance of the surface's sampled points from the first one, metres.
inline double size_of(const Surface& s) {
  const ParameterBox box = s.domain();
  const Point first = s.point({box.u.from, box.v.from});
  double size = norm(first);
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; j <= 8; ++j) size = std::max(size, norm(s.point({box.u.from + box.u.length() * i / 8.0, box.v.from + box.v.length() * j / 8.0})));
  return size;
}

inline bool is_near(double t, const std::vector<double>& breaks, double step) {
  for (const double b : breaks)
    if (std::abs(t - b) <= 2.0 * step) return true;
  return false;
}

/// Within a piece of an analytic function, central differences of step h and h/2 differ from the derivative by c h^2 + O(h^4). The error falls fourfold, or
/// is rounding.
/// \pre no knot within 2 h: where c jumps, the error falls by as little as half
inline void expect_second_order(const Vec3& exact, const Vec3& coarse, const Vec3& fine, double rounding, const char* what) {
  constexpr double k_least_fall = 0.3;  // a quarter, plus the contribution of O(h^4)
  const double e1 = norm(coarse - exact), e2 = norm(fine - exact);
  EXPECT_LE(e2, k_least_fall * e1 + rounding) << what << ": " << e1 << " -> " << e2;
}

/// Returns the breaks, and all knots if they are known: a spline's third derivative jumps at knots, and breaks do not include such jumps.
inline std::array<std::vector<double>, 2> knots_of(const Surface& s) {
  std::array<std::vector<double>, 2> knots{s.breaks_u(), s.breaks_v()};
  if (const auto form = s.exact_nurbs()) {
    knots[0].insert(knots[0].end(), form->knots_u.begin(), form->knots_u.end());
    knots[1].insert(knots[1].end(), form->knots_v.begin(), form->knots_v.end());
  }
  return knots;
}
inline std::vector<double> knots_of(const Curve& c) {
  std::vector<double> knots = c.breaks();
  if (const auto form = c.exact_nurbs()) knots.insert(knots.end(), form->knots.begin(), form->knots.end());
  return knots;
}

inline void expect_derivatives(const Surface& s, int n = 60) {
  const ParameterBox box = s.domain();
  const double size = size_of(s);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.02, 0.98);
  const double hu = 2e-3 * box.u.length(), hv = 2e-3 * box.v.length();
  // Rounding of a second difference: a few ulps of the coordinates divided by the smallest step squared.
  const double r1 = 1e-14 * size, r2 = 4e-14 * size;
  const auto knots = knots_of(s);
  for (int k = 0; k < n; ++k) {
    const Uv at{box.u.from + unit(random) * box.u.length(), box.v.from + unit(random) * box.v.length()};
    if (is_near(at.u, knots[0], hu) || is_near(at.v, knots[1], hv)) continue;
    const SurfaceDerivatives d = s.derivatives(at);
    EXPECT_LE(distance(d.point, s.point(at)), 1e-14 * size);
    Vec3 du[2], dv[2], duu[2], duv[2], dvv[2];
    for (int level = 0; level < 2; ++level) {
      const double a = hu / (1 << level), b = hv / (1 << level);
      const auto p = [&](double i, double j) { return s.point({at.u + i * a, at.v + j * b}); };
      du[level] = (p(1, 0) - p(-1, 0)) / (2 * a);
      dv[level] = (p(0, 1) - p(0, -1)) / (2 * b);
      duu[level] = (p(1, 0) - 2.0 * p(0, 0) + p(-1, 0)) / (a * a);
      dvv[level] = (p(0, 1) - 2.0 * p(0, 0) + p(0, -1)) / (b * b);
      duv[level] = (p(1, 1) - p(1, -1) - p(-1, 1) + p(-1, -1)) / (4 * a * b);
    }
    SCOPED_TRACE(s.kind() + " at " + std::to_string(at.u) + ", " + std::to_string(at.v));
    expect_second_order(d.du, du[0], du[1], r1 / hu + 1e-9 * norm(d.du), "du");
    expect_second_order(d.dv, dv[0], dv[1], r1 / hv + 1e-9 * norm(d.dv), "dv");
    expect_second_order(d.duu, duu[0], duu[1], r2 / (hu * hu) * 4 + 1e-9 * norm(d.duu), "duu");
    expect_second_order(d.dvv, dvv[0], dvv[1], r2 / (hv * hv) * 4 + 1e-9 * norm(d.dvv), "dvv");
    expect_second_order(d.duv, duv[0], duv[1], r2 / (hu * hv) * 4 + 1e-9 * norm(d.duv), "duv");
  }
}

inline void expect_batch(const Surface& s) {
  const ParameterBox box = s.domain();
  std::vector<Uv> at;
  for (int i = 0; i <= 12; ++i) at.push_back({box.u.from + box.u.length() * i / 12.0, box.v.from + box.v.length() * ((5 * i) % 13) / 12.0});
  std::vector<Point> points(at.size());
  s.points(at, points);
  for (std::size_t i = 0; i < at.size(); ++i) EXPECT_EQ(points[i], s.point(at[i]));
}

/// Checks that the NURBS form gives the same points and derivatives.
inline void expect_exact_nurbs(const Surface& s, double tolerance = 1e-13) {
  const auto form = s.exact_nurbs();
  ASSERT_TRUE(form.has_value()) << s.kind();
  const NurbsSurface nurbs(*form);
  EXPECT_EQ(nurbs.domain(), s.domain());
  const double size = size_of(s);
  const ParameterBox box = s.domain();
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    const Uv at{box.u.from + unit(random) * box.u.length(), box.v.from + unit(random) * box.v.length()};
    const SurfaceDerivatives a = s.derivatives(at), b = nurbs.derivatives(at);
    EXPECT_LE(distance(a.point, b.point), tolerance * size) << s.kind();
    EXPECT_LE(distance(a.du, b.du), 100 * tolerance * (norm(a.du) + size / box.u.length()));
    EXPECT_LE(distance(a.dv, b.dv), 100 * tolerance * (norm(a.dv) + size / box.v.length()));
  }
}

inline void expect_derivatives(const Curve& c, int n = 60) {
  const Interval range = c.domain();
  double size = 0.0;
  for (int i = 0; i <= 16; ++i) size = std::max(size, norm(c.point(range.from + range.length() * i / 16.0)));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.02, 0.98);
  const double h = 2e-3 * range.length();
  const std::vector<double> knots = knots_of(c);
  for (int k = 0; k < n; ++k) {
    const double t = range.from + unit(random) * range.length();
    if (is_near(t, knots, h)) continue;
    const CurveDerivatives d = c.derivatives(t);
    EXPECT_LE(distance(d.point, c.point(t)), 1e-14 * size);
    Vec3 first[2], second[2];
    for (int level = 0; level < 2; ++level) {
      const double a = h / (1 << level);
      first[level] = (c.point(t + a) - c.point(t - a)) / (2 * a);
      second[level] = (c.point(t + a) - 2.0 * c.point(t) + c.point(t - a)) / (a * a);
    }
    expect_second_order(d.first, first[0], first[1], 1e-14 * size / h + 1e-9 * norm(d.first), "first");
    expect_second_order(d.second, second[0], second[1], 2e-13 * size / (h * h) + 1e-9 * norm(d.second), "second");
  }
}

inline void expect_exact_nurbs(const Curve& c, double tolerance = 1e-13) {
  const auto form = c.exact_nurbs();
  ASSERT_TRUE(form.has_value());
  const NurbsCurve nurbs(*form);
  EXPECT_EQ(nurbs.domain(), c.domain());
  const Interval range = c.domain();
  double size = 0.0;
  for (int i = 0; i <= 16; ++i) size = std::max(size, norm(c.point(range.from + range.length() * i / 16.0)));
  for (int i = 0; i <= 200; ++i) {
    const double t = range.from + range.length() * i / 200.0;
    EXPECT_LE(distance(c.point(t), nurbs.point(t)), tolerance * size);
  }
}

}  // namespace sterna::test
