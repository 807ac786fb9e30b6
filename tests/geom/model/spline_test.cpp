#include "geom/model/spline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "tests/geom/model/evaluator_checks.h"

namespace sterna {
namespace {

constexpr SplineTangents k_cubic[] = {SplineTangents::natural, SplineTangents::clamped, SplineTangents::not_a_knot,
                                      SplineTangents::akima,   SplineTangents::bessel,  SplineTangents::monotone};

std::vector<Point> helix(int n, double turns = 0.8) {
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) {
    const double t = std::pow(i / (n - 1.0), 1.3) * turns * 2.0 * std::numbers::pi;
    points.push_back({std::cos(t), std::sin(t), 0.2 * t});
  }
  return points;
}

std::vector<Point> ring(int n) {
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) points.push_back({2.0 * std::cos(2.0 * std::numbers::pi * i / n), std::sin(2.0 * std::numbers::pi * i / n), 0.3});
  points.push_back(points.front());
  return points;
}

TEST(Spline, GoesThroughItsPointsAtTheirParameters) {
  for (const SplineParameters parameters : {SplineParameters::uniform, SplineParameters::chord_length, SplineParameters::centripetal})
    for (const SplineTangents tangents : k_cubic)
      for (const int n : {2, 3, 4, 5, 20}) {
        const std::vector<Point> points = helix(n);
        const SplineOptions options{.tangents = tangents, .parameters = parameters};
        const CurvePtr curve = spline_curve(points, options);
        const std::vector<double> t = spline_parameters(points, parameters);
        for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LE(distance(curve->point(t[i]), points[i]), 1e-14) << static_cast<int>(tangents) << " " << n;
        test::expect_derivatives(*curve, 10);
      }
}

TEST(Spline, ReproducesCubicsWhereItMust) {
  // Not-a-knot and clamped splines reproduce any cubic; Bessel splines any parabola; all of them straight lines.
  const auto cubic = [](double t) { return Point{t * t * t - t, 2.0 * t * t + 1.0, 3.0 - t}; };
  const auto parabola = [](double t) { return Point{t * t, 1.0 - 3.0 * t, 0.5 * t * t + t}; };
  const std::vector<double> at{0.0, 0.3, 0.5, 1.1, 1.2, 2.0};
  std::vector<Point> on_cubic, on_parabola;
  for (const double t : at) {
    on_cubic.push_back(cubic(t));
    on_parabola.push_back(parabola(t));
  }
  const CurvePtr open = spline_curve(on_cubic, {.tangents = SplineTangents::not_a_knot, .at = at});
  const CurvePtr clamped =
      spline_curve(on_cubic, {.tangents = SplineTangents::clamped, .at = at, .start_tangents = {{-1.0, 0.0, -1.0}}, .end_tangents = {{11.0, 8.0, -1.0}}});
  const CurvePtr bessel = spline_curve(on_parabola, {.tangents = SplineTangents::bessel, .at = at});
  for (double t = 0.0; t <= 2.0; t += 0.05) {
    EXPECT_LE(distance(open->point(t), cubic(t)), 1e-13);
    EXPECT_LE(distance(clamped->point(t), cubic(t)), 1e-13);
    EXPECT_LE(distance(bessel->point(t), parabola(t)), 1e-13);
  }
}

TEST(Spline, ContinuityIsWhatTheTangentsPromise) {
  const std::vector<Point> points = helix(9);
  for (const SplineTangents tangents : k_cubic) {
    const CurvePtr curve = spline_curve(points, {.tangents = tangents});
    const bool is_c2 = tangents == SplineTangents::natural || tangents == SplineTangents::clamped || tangents == SplineTangents::not_a_knot;
    EXPECT_EQ(curve->breaks().empty(), is_c2);
    const std::vector<double> t = spline_parameters(points, SplineParameters::chord_length);
    for (std::size_t i = 1; i + 1 < t.size(); ++i) {
      const CurveDerivatives before = curve->derivatives(t[i] - 1e-12), after = curve->derivatives(t[i] + 1e-12);
      EXPECT_LE(distance(before.first, after.first), 1e-8);
      if (is_c2) {
        EXPECT_LE(distance(before.second, after.second), 1e-7);
      }
    }
  }
  const CurvePtr natural = spline_curve(points, {.tangents = SplineTangents::natural});
  EXPECT_LE(norm(natural->derivatives(0.0).second), 1e-10);
  EXPECT_LE(norm(natural->derivatives(1.0).second), 1e-10);
}

TEST(Spline, PeriodicSplinesCloseSmoothly) {
  for (const SplineTangents tangents : {SplineTangents::periodic, SplineTangents::akima, SplineTangents::bessel}) {
    const CurvePtr curve = spline_curve(ring(17), {.tangents = tangents, .is_closed = true});
    EXPECT_TRUE(curve->is_periodic());
    const CurveDerivatives a = curve->derivatives(0.0), b = curve->derivatives(1.0 - 1e-15);
    EXPECT_LE(distance(a.point, b.point), 1e-12);
    EXPECT_LE(distance(a.first, b.first), 1e-10);
    if (tangents == SplineTangents::periodic) {
      EXPECT_LE(distance(a.second, b.second), 1e-8);
    }
    EXPECT_LE(distance(curve->point(0.3), curve->point(1.3)), 1e-13);
    EXPECT_LE(distance(curve->point(0.3), curve->point(-0.7)), 1e-13);
  }
}

TEST(Spline, OrderOfConvergenceIsFourOnACircle) {
  double before = 0.0;
  for (const int n : {16, 32, 64}) {
    const CurvePtr curve = spline_curve(ring(n), {.tangents = SplineTangents::periodic, .parameters = SplineParameters::uniform});
    double error = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const Point p = curve->point(i / 1000.0);
      error = std::max(error, distance(p, {2.0 * std::cos(2.0 * std::numbers::pi * i / 1000.0), std::sin(2.0 * std::numbers::pi * i / 1000.0), 0.3}));
    }
    if (before > 0.0) {
      EXPECT_GT(before / error, 14.0);
    }
    before = error;
  }
}

TEST(Spline, AkimaKeepsStraightSegmentsStraight) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {2.5, 0, 0}, {3, 0, 0}, {4, 1, 0}, {5, 3, 0}, {6, 5, 0}, {7, 7, 0}};
  const CurvePtr curve = spline_curve(points, {.tangents = SplineTangents::akima});
  const std::vector<double> t = spline_parameters(points, SplineParameters::chord_length);
  for (double s = 0.0; s < t[2]; s += 0.001) EXPECT_LE(std::abs(curve->point(s).y), 1e-14);
  double wiggle = 0.0;
  const CurvePtr smooth = spline_curve(points, {});
  for (double s = 0.0; s < t[2]; s += 0.001) wiggle = std::max(wiggle, std::abs(smooth->point(s).y));
  EXPECT_GT(wiggle, 1e-3);
}

TEST(Spline, MonotoneTangentsDoNotOvershoot) {
  // Uneven steps, a plateau and turning points in each coordinate: with Bessel tangents the curve overshoots all of them.
  const std::vector<Point> points{{0, 0, 1}, {0.1, 1, 1}, {0.2, 1.05, 1}, {3, 1.05, 0.2}, {3.1, 0.2, 0.1}, {3.1, 0.1, 4}, {5, 0.1, 4.1}};
  const std::vector<double> t = spline_parameters(points, SplineParameters::chord_length);
  const CurvePtr monotone = spline_curve(points, {.tangents = SplineTangents::monotone}), bessel = spline_curve(points, {.tangents = SplineTangents::bessel});
  double beyond_of_bessel = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    for (int k = 0; k <= 100; ++k) {
      const double at = t[i] + (t[i + 1] - t[i]) * k / 100.0;
      const Point p = monotone->point(at), q = bessel->point(at);
      for (std::size_t c = 0; c < 3; ++c) {
        const double low = std::min(points[i][c], points[i + 1][c]), high = std::max(points[i][c], points[i + 1][c]);
        EXPECT_GE(p[c], low - 1e-14) << "segment " << i << " coordinate " << c;
        EXPECT_LE(p[c], high + 1e-14) << "segment " << i << " coordinate " << c;
        beyond_of_bessel = std::max({beyond_of_bessel, low - q[c], q[c] - high});
      }
    }
  EXPECT_GT(beyond_of_bessel, 0.01);
  // The monotone curve is still smooth.
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    EXPECT_LE(norm(monotone->derivatives(t[i] - 1e-9).first - monotone->derivatives(t[i] + 1e-9).first), 1e-5) << i;
}

TEST(Spline, CornersStaySharpAndPiecesAreIndependent) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0.1, 0}, {2, 0, 0}, {2, 1, 0.2}, {2, 2, 0}};
  for (const SplineTangents tangents : {SplineTangents::natural, SplineTangents::not_a_knot, SplineTangents::akima, SplineTangents::bessel}) {
    const CurvePtr curve = spline_curve(points, {.tangents = tangents, .corners = {2}});
    const std::vector<double> t = spline_parameters(points, SplineParameters::chord_length);
    EXPECT_LE(distance(curve->point(t[2]), points[2]), 1e-14);
    EXPECT_GT(angle_between(curve->derivatives(t[2] - 1e-9).first, curve->derivatives(t[2] + 1e-9).first), 1.0);
    EXPECT_THAT(curve->breaks(), testing::Contains(testing::DoubleNear(t[2], 1e-15)));
    std::vector<Point> moved = points;
    moved[4] = {3, 2, 0};
    const std::vector<double> fixed_at{0, 1, 2, 3, 4};
    const CurvePtr a = spline_curve(points, {.tangents = tangents, .at = fixed_at, .corners = {2}}),
                   b = spline_curve(moved, {.tangents = tangents, .at = fixed_at, .corners = {2}});
    EXPECT_LE(distance(a->point(1.4), b->point(1.4)), 1e-15);
  }
}

TEST(Spline, UnevenPointsStayAccurate) {
  std::vector<Point> points;
  for (const double x : {0.0, 1e-6, 2e-6, 1e-3, 0.5, 0.9999, 1.0}) points.push_back({x, x * x, 0.0});
  for (const SplineTangents tangents : k_cubic) {
    const CurvePtr curve = spline_curve(points, {.tangents = tangents});
    const std::vector<double> t = spline_parameters(points, SplineParameters::chord_length);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LE(distance(curve->point(t[i]), points[i]), 1e-13) << static_cast<int>(tangents);
  }
}

TEST(Spline, MistakesAreNamedWithTheirPlace) {
  const auto message = [](const std::vector<Point>& points, const SplineOptions& options) -> std::string {
    try {
      (void)spline_form(points, options);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(message({{1, 2, 3}}, {}), testing::HasSubstr("1 points"));
  EXPECT_THAT(message({{0, 0, 0}, {1, 2, 3}, {1, 2, 3}}, {}), testing::AllOf(testing::HasSubstr("points 1 and 2 coincide"), testing::HasSubstr("(1, 2, 3)")));
  EXPECT_THAT(message(helix(5), {.tangents = SplineTangents::periodic}), testing::HasSubstr("must repeat the first"));
  EXPECT_THAT(message(helix(5), {.at = {0, 1, 2}}), testing::HasSubstr("3 parameters for 5 points"));
  EXPECT_THAT(message(helix(3), {.at = {0, 1, 1}}), testing::HasSubstr("not in ascending order"));
  EXPECT_THAT(message(helix(5), {.corners = {4}}), testing::HasSubstr("not an inner point"));
  EXPECT_THAT(message(helix(5), {.tangents = SplineTangents::natural, .start_tangents = {{1, 0, 0}}}), testing::HasSubstr("not `clamped`"));
}

PointGrid wing_grid(std::size_t n_u, std::size_t n_v) {
  PointGrid grid{n_u, n_v, {}};
  for (std::size_t i = 0; i < n_u; ++i)
    for (std::size_t j = 0; j < n_v; ++j) {
      const double a = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n_u - 1),
                   y = static_cast<double>(j) / static_cast<double>(n_v - 1);
      const double chord = 2.0 - y;
      grid.points.push_back({y + chord * 0.5 * (1.0 + std::cos(a)), 5.0 * y, chord * 0.06 * std::sin(a) + 0.1 * y * y});
    }
  for (std::size_t j = 0; j < n_v; ++j) grid.points[(n_u - 1) * n_v + j] = grid.points[j];
  return grid;
}

TEST(SplineSurface, GoesThroughTheGridInEveryCombination) {
  const PointGrid grid = wing_grid(13, 6);
  const SplineTangents all[] = {SplineTangents::natural, SplineTangents::not_a_knot, SplineTangents::akima,
                                SplineTangents::bessel,  SplineTangents::linear,     SplineTangents::periodic};
  for (const SplineTangents tu : all)
    for (const SplineTangents tv : all) {
      if (tv == SplineTangents::periodic) continue;
      std::vector<double> at_u, at_v;
      for (int i = 0; i < 13; ++i) at_u.push_back(0.1 * i + 0.002 * i * i);
      for (int j = 0; j < 6; ++j) at_v.push_back(j);
      const SurfacePtr surface = spline_surface(grid, {.tangents = tu, .at = at_u}, {.tangents = tv, .at = at_v});
      for (std::size_t i = 0; i < 13; ++i)
        for (std::size_t j = 0; j < 6; ++j) EXPECT_LE(distance(surface->point({at_u[i], at_v[j]}), grid(i, j)), 1e-14);
      test::expect_derivatives(*surface, 8);
      EXPECT_EQ(surface->is_periodic_u(), tu == SplineTangents::periodic);
      const bool lu = tu == SplineTangents::linear, lv = tv == SplineTangents::linear;
      EXPECT_EQ(surface->kind(), lu && lv ? "bilinear spline" : lu || lv ? "linear-cubic spline" : "bicubic spline");
    }
}

TEST(SplineSurface, ColumnsAreTheSplinesOfTheirPoints) {
  const PointGrid grid = wing_grid(11, 5);
  const SplineOptions u{.tangents = SplineTangents::akima};
  const SurfacePtr surface = spline_surface(grid, u, {.tangents = SplineTangents::not_a_knot, .at = {0, 1, 2, 3, 4}});
  const auto form = surface->exact_nurbs();
  ASSERT_TRUE(form);
  std::vector<Point> column;
  std::vector<double> at_u;
  for (std::size_t i = 0; i < 11; ++i) column.push_back(grid(i, 2));
  for (std::size_t k = 0; k < form->knots_u.size(); ++k)
    if (k == 0 || form->knots_u[k] > form->knots_u[k - 1]) at_u.push_back(form->knots_u[k]);
  const CurvePtr curve = spline_curve(column, {.tangents = SplineTangents::akima, .at = at_u});
  for (double t = 0.0; t <= 1.0; t += 0.01) EXPECT_LE(distance(surface->point({t, 2.0}), curve->point(t)), 1e-14);
}

TEST(SplineSurface, PolesAndClampedBordersWork) {
  // A body of revolution whose first and last rows are points.
  PointGrid grid{9, 7, {}};
  std::vector<Vec3> start, end;
  for (int i = 0; i < 9; ++i) {
    const double a = std::numbers::pi * i / 8.0;
    for (int j = 0; j < 7; ++j) {
      const double x = -std::cos(std::numbers::pi * j / 6.0), r = j == 0 || j == 6 ? 0.0 : std::sin(std::numbers::pi * j / 6.0);
      grid.points.push_back({x, r * std::sin(a), -r * std::cos(a)});
    }
    start.push_back({0, std::numbers::pi * std::sin(a), -std::numbers::pi * std::cos(a)});
    end.push_back({0, -std::numbers::pi * std::sin(a), std::numbers::pi * std::cos(a)});
  }
  const SurfacePtr surface =
      spline_surface(grid, {}, {.tangents = SplineTangents::clamped, .parameters = SplineParameters::uniform, .start_tangents = start, .end_tangents = end});
  for (double u = 0.0; u <= 1.0; u += 0.125) {
    EXPECT_LE(distance(surface->point({u, 0.0}), {-1, 0, 0}), 1e-14);
    for (double v = 0.0; v <= 1.0; v += 0.1) EXPECT_NEAR(norm(surface->point({u, v})), 1.0, 2e-3);
  }
  const SurfaceDerivatives d = surface->derivatives({0.0, 0.0});
  EXPECT_LE(distance(d.dv, {0, 0, -std::numbers::pi}), 1e-12);
}

}  // namespace
}  // namespace sterna
