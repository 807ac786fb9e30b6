#include "geom/model/sampled.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "geom/base/error.h"
#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/space_map.h"
#include "geom/model/spline.h"
#include "tests/support/error_of.h"

namespace sterna {
namespace {

using test::message_of;

/// Returns the largest distance at random parameters, none of which the sampling evaluated.
double largest_error(const Surface& a, const std::function<Point(Uv)>& f) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const ParameterBox box = a.domain();
  double error = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const Uv at{box.u.from + unit(random) * box.u.length(), box.v.from + unit(random) * box.v.length()};
    error = std::max(error, distance(a.point(at), f(at)));
  }
  return error;
}

TEST(SampledSurface, ToleranceHoldsBetweenTheSamples) {
  const auto wavy = [](Uv p) { return Point{p.u, p.v, 0.3 * std::sin(3.0 * p.u) * std::cos(2.0 * p.v) + std::exp(-20.0 * (p.u - 1.0) * (p.u - 1.0))}; };
  std::size_t before = 0;
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const SampledSurface s = sample_surface(wavy, {{0, 3}, {-1, 2}}, {.tolerance = tolerance});
    EXPECT_LE(s.error, tolerance);
    EXPECT_LE(largest_error(*s.surface, wavy), 1.3 * tolerance);  // tolerance holds at the 8 points per cell; between these points the error may be larger
    EXPECT_NEAR(distance(s.surface->point(s.worst), wavy(s.worst)), s.error, 1e-15);
    EXPECT_GT(s.n_u * s.n_v, before);
    before = s.n_u * s.n_v;
    EXPECT_EQ(s.surface->domain(), (ParameterBox{{0, 3}, {-1, 2}}));
  }
  // A cubic needs no refinement.
  const auto cubic = [](Uv p) { return Point{p.u * p.u * p.u, p.v, p.u * p.v * p.v}; };
  const SampledSurface s = sample_surface(cubic, {{0, 1}, {0, 1}}, {.tolerance = 1e-12});
  EXPECT_EQ(s.n_u, 5u);
  EXPECT_LE(largest_error(*s.surface, cubic), 1e-14);
}

TEST(SampledSurface, BreaksAndPeriodsAreKept) {
  const auto kinked = [](Uv p) { return Point{p.u, p.v, std::abs(p.u - 0.37)}; };
  const SampledSurface s = sample_surface(kinked, {{0, 1}, {0, 1}}, {.tolerance = 1e-9, .breaks_u = {0.37}});
  EXPECT_EQ(s.surface->breaks_u(), std::vector<double>{0.37});
  EXPECT_LE(largest_error(*s.surface, kinked), 1e-9);
  EXPECT_THAT(message_of([&] {
                (void)sample_surface(kinked, {{0, 1}, {0, 1}}, {.tolerance = 1e-9, .max_intervals = 60});
              }),
              testing::AllOf(testing::HasSubstr("with 60 intervals"), testing::HasSubstr("(0.36")));

  for (const Surface* surface : {static_cast<const Surface*>(new SphereSurface({}, 2.0)), static_cast<const Surface*>(new TorusSurface({}, 2.0, 0.5))}) {
    const std::unique_ptr<const Surface> owner(surface);
    const SampledSurface fit = sample_surface(*surface, 1e-5);
    EXPECT_EQ(fit.surface->is_periodic_u(), surface->is_periodic_u());
    EXPECT_EQ(fit.surface->is_periodic_v(), surface->is_periodic_v());
    EXPECT_LE(largest_error(*fit.surface, [&](Uv p) { return surface->point(p); }), 1.3e-5);
  }
  PointGrid grid{6, 5, {}};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 5; ++j) grid.points.push_back({1.0 * i, 1.0 * j, std::sin(1.1 * i + j)});
  const SurfacePtr base = spline_surface(grid, {.tangents = SplineTangents::akima}, {.tangents = SplineTangents::linear});
  const DeformedSurface bent(base, std::make_shared<FunctionMap>([](const Point& p) { return Point{p.x, p.y, p.z + 0.1 * p.x * p.x}; }, 1e-3));
  const SampledSurface fit = sample_surface(bent, 1e-6);
  EXPECT_EQ(fit.surface->breaks_u(), bent.breaks_u());
  EXPECT_LE(largest_error(*fit.surface, [&](Uv p) { return bent.point(p); }), 1.3e-6);
}

TEST(SampledSurface, MistakesAreNamed) {
  const auto plane = [](Uv p) { return Point{p.u, p.v, 0.0}; };
  EXPECT_THAT(message_of([&] { (void)sample_surface(plane, {{0, 1}, {0, 1}}, {.tolerance = 0.0}); }), testing::HasSubstr("tolerance"));
  EXPECT_THAT(message_of([&] { (void)sample_surface(plane, {{0, 1}, {1, 1}}, {}); }), testing::HasSubstr("no length"));
  EXPECT_THAT(message_of([&] { (void)sample_surface(plane, {{0, 1}, {0, 1}}, {.is_periodic_u = true}); }), testing::HasSubstr("declared periodic"));
  EXPECT_THAT(message_of([&] { (void)sample_surface(plane, {{0, 1}, {0, 1}}, {.breaks_u = {2.0}}); }), testing::HasSubstr("outside the range"));
  EXPECT_THAT(message_of([&] {
                (void)sample_surface([](Uv p) { return Point{std::log(p.u - 0.5), 0, 0}; }, {{0, 1}, {0, 1}}, {});
              }),
              testing::HasSubstr("not finite at (u, v) = (0"));
}

TEST(SampledCurve, ToleranceHoldsBetweenTheSamples) {
  const EllipseCurve ellipse({1, 2, 3}, {3, 0, 0}, {0, 1, 0}, k_full_turn);
  const SampledCurve c = sample_curve(ellipse, 1e-7);
  EXPECT_TRUE(c.curve->is_periodic());
  double error = 0.0;
  for (int i = 0; i <= 3000; ++i) error = std::max(error, distance(c.curve->point(i * k_full_turn.to / 3000.0), ellipse.point(i * k_full_turn.to / 3000.0)));
  EXPECT_LE(error, 1.2e-7);
  EXPECT_THAT(message_of([] {
                (void)sample_curve([](double t) { return Point{t, std::abs(t - 0.3), 0}; }, {0, 1}, {.tolerance = 1e-9, .max_intervals = 40});
              }),
              testing::HasSubstr("t = 0.29"));
}

}  // namespace
}  // namespace sterna
