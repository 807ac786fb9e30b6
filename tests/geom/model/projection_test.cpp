#include "geom/model/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geom/base/error.h"
#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/spline.h"
#include "geom/model/swept_surfaces.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"

namespace sterna {
namespace {

using test::k_pi;

/// Returns a tapered, twisted wing with a round leading edge and a sharp trailing edge, as in sumo: u around the section, v along the span.
SurfacePtr wing() {
  PointGrid grid{33, 7, {}};
  for (int i = 0; i < 33; ++i)
    for (int j = 0; j < 7; ++j) {
      const double a = 2.0 * k_pi * i / 32.0, y = j / 6.0, chord = 3.0 - 2.0 * y;
      const double x = 0.5 * (1.0 + std::cos(a)), t = 0.6 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
      const double z = i <= 16 ? t : -t, twist = 0.1 * y;
      grid.points.push_back(
          {4.0 * y + chord * (x * std::cos(twist) + z * std::sin(twist)), 12.0 * y, chord * (z * std::cos(twist) - x * std::sin(twist)) + y * y});
    }
  return spline_surface(grid, {}, {});
}

TEST(SurfaceProjector, FindsTheFootOfNormalsOnAWing) {
  const SurfacePtr s = wing();
  const SurfaceProjector projector(s);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 2000; ++k) {
    const Uv at{0.02 + 0.96 * unit(random), 0.02 + 0.96 * unit(random)};
    const SurfaceDerivatives d = s->derivatives(at);
    const Vec3 n = normalized(cross(d.du, d.dv));
    const double height = 1e-3 * unit(random);
    const Point p = d.point + height * n;
    const SurfaceProjection projection = projector.seeded(p, {std::clamp(at.u + 0.01 * (unit(random) - 0.5), 0.0, 1.0), at.v + 0.02 * (unit(random) - 0.5)});
    EXPECT_LE(projection.distance, height + 1e-12);
    EXPECT_LE(distance(projection.point, s->point(projection.at)), 1e-14 * 10);
    EXPECT_LE(std::abs(projection.distance - distance(projection.point, p)), 1e-14);
    // The result is either the expected nearest point or, near the thin trailing edge, a nearer point.
    if (projection.distance >= height - 1e-12) {
      EXPECT_LE(distance(projection.point, d.point), 1e-7 * std::sqrt(height) + 1e-10);
    }
  }
}

TEST(SurfaceProjector, NearestAgreesWithBruteForce) {
  const Frame frame = frame_along({0.3, -0.2, 1.0}, {1.0, 2.0, 0.5});
  const std::vector<SurfacePtr> surfaces{wing(), std::make_shared<SphereSurface>(frame, 1.5), std::make_shared<TorusSurface>(frame, 2.0, 0.6),
                                         std::make_shared<CylinderSurface>(frame, 0.7, ParameterBox{k_full_turn, {-1, 2}}),
                                         std::make_shared<ConeSurface>(frame, 0.0, 0.4, ParameterBox{k_full_turn, {0, 2}})};
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const SurfacePtr& s : surfaces) {
    const SurfaceProjector projector(s);
    const ParameterBox box = s->domain();
    std::vector<Point> samples;
    for (int i = 0; i <= 300; ++i)
      for (int j = 0; j <= 300; ++j) samples.push_back(s->point({box.u.from + box.u.length() * i / 300.0, box.v.from + box.v.length() * j / 300.0}));
    for (int k = 0; k < 60; ++k) {
      const Point base = samples[static_cast<std::size_t>((unit(random) + 1.0) * 0.4999 * static_cast<double>(samples.size()))];
      const Point p = base + std::pow(10.0, unit(random)) * Vec3{unit(random), unit(random), unit(random)};
      double least = 1e300;
      for (const Point& q : samples) least = std::min(least, distance(p, q));
      const SurfaceProjection projection = projector.nearest(p);
      EXPECT_LE(projection.distance, least + 1e-12) << s->kind() << " " << k;
      EXPECT_GE(projection.distance, least - 0.05) << s->kind();
      EXPECT_TRUE(box.u.contains(projection.at.u) && box.v.contains(projection.at.v));
    }
  }
}

TEST(SurfaceProjector, AnalyticDistances) {
  const SurfaceProjector sphere(std::make_shared<SphereSurface>(Frame{}, 2.0)), torus(std::make_shared<TorusSurface>(Frame{}, 2.0, 0.5));
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 300; ++k) {
    const Point p = 2.0 * Vec3{normal(random), normal(random), normal(random)};
    EXPECT_NEAR(sphere.nearest(p).distance, std::abs(norm(p) - 2.0), 1e-12);
    EXPECT_NEAR(torus.nearest(p).distance, std::abs(std::hypot(std::hypot(p.x, p.y) - 2.0, p.z) - 0.5), 1e-12);
  }
  // Degenerate locations: the centre, the axis, the poles from inside and outside.
  EXPECT_NEAR(sphere.nearest({0, 0, 0}).distance, 2.0, 1e-14);
  for (const double z : {2.5, 1.5, -2.5, 2.0, 1e-9}) {
    EXPECT_NEAR(sphere.nearest({0, 0, z}).distance, std::abs(2.0 - std::abs(z)), 1e-12);
    EXPECT_NEAR(sphere.seeded({1e-5, -2e-5, z}, {1.0, std::copysign(1.5, z)}).distance, std::abs(2.0 - norm(Vec3{1e-5, -2e-5, z})), 1e-12);
  }
  EXPECT_NEAR(torus.nearest({0, 0, 0}).distance, 1.5, 1e-12);
}

TEST(SurfaceProjector, CrossesSeamsPolesAndKeepsToBorders) {
  const SurfacePtr sphere = std::make_shared<SphereSurface>(Frame{}, 1.0);
  const SurfaceProjector projector(sphere);
  // Seed on the other side of the seam.
  const Point across = 1.1 * sphere->point({0.05, 0.3});
  const SurfaceProjection projection = projector.seeded(across, {2.0 * k_pi - 0.05, 0.25});
  EXPECT_NEAR(projection.distance, 0.1, 1e-13);
  EXPECT_NEAR(projection.at.u, 0.05, 1e-9);
  // Seed at the pole and beyond it.
  for (const double u : {0.1, 2.0, 4.5}) {
    const Point p = 1.2 * sphere->point({u, 0.5 * k_pi - 0.2});
    EXPECT_NEAR(projector.seeded(p, {0.0, 0.5 * k_pi}).distance, 0.2, 1e-12);
    EXPECT_NEAR(projector.seeded(p, {u + k_pi, 0.5 * k_pi - 0.01}).distance, 0.2, 1e-12) << u;
  }
  // Borders of a plane: sides and corners.
  const SurfacePtr plane = std::make_shared<PlaneSurface>(Frame{}, ParameterBox{{0, 2}, {0, 1}});
  const SurfaceProjector flat(plane);
  EXPECT_EQ(flat.seeded({3, 0.5, 1}, {1, 0.5}).at, (Uv{2.0, 0.5}));
  EXPECT_EQ(flat.seeded({3, 5, 0}, {1, 0.5}).at, (Uv{2.0, 1.0}));
  EXPECT_NEAR(flat.nearest({-1, -1, 0}).distance, std::numbers::sqrt2, 1e-14);
  // A projection on a part of a surface stays within the part's parameter box.
  const SurfaceProjector part(sphere, {{1.0, 2.0}, {-0.5, 0.5}});
  const SurfaceProjection limited = part.nearest({1, 0, 0});
  EXPECT_NEAR(limited.at.u, 1.0, 1e-12);
  EXPECT_NEAR(limited.at.v, 0.0, 1e-9);
  test::expect_error(ErrorCode::bad_argument, "the parameter range [1, 1] has no length", [&] { (void)SurfaceProjector(sphere, {{1.0, 1.0}, {0.0, 1.0}}); });
}

TEST(SurfaceProjector, SameForAnyNumberOfThreads) {
  const SurfaceProjector projector(wing());
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::vector<Point> points;
  for (int k = 0; k < 3000; ++k) points.push_back({5.0 + 3.0 * normal(random), 6.0 + 4.0 * normal(random), normal(random)});
  std::vector<SurfaceProjection> one(points.size()), seven(points.size());
  projector.project(points, {}, one, RunContext({.threads = 1}));
  projector.project(points, {}, seven, RunContext({.threads = 7}));
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(one[i].at, seven[i].at);
}

TEST(CurveProjector, AgreesWithBruteForceAndStaysWithinEnds) {
  std::vector<Point> points;
  for (int i = 0; i <= 20; ++i) points.push_back({std::cos(0.6 * i), std::sin(0.6 * i), 0.1 * i * std::cos(0.2 * i)});
  const std::vector<CurvePtr> curves{spline_curve(points, {}), spline_curve(points, {.tangents = SplineTangents::akima}),
                                     circle(frame_along({1, 0, 0}, {1, 1, 1}), 2.0, k_full_turn), circle({}, 2.0, {0.3, 1.9}), segment({0, 0, 0}, {1, 2, 3})};
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const CurvePtr& c : curves) {
    const CurveProjector projector(c);
    const Interval range = c->domain();
    for (int k = 0; k < 100; ++k) {
      const Point p = 1.5 * Vec3{normal(random), normal(random), normal(random)};
      double least = 1e300;
      for (int i = 0; i <= 4000; ++i) least = std::min(least, distance(p, c->point(range.from + range.length() * i / 4000.0)));
      const CurveProjection projection = projector.nearest(p);
      EXPECT_LE(projection.distance, least + 1e-12);
      EXPECT_GE(projection.distance, least - 1e-4);
      EXPECT_TRUE(range.contains(projection.t));
    }
  }
  const CurveProjector line(segment({0, 0, 0}, {2, 0, 0}));
  EXPECT_EQ(line.nearest({5, 1, 0}).t, 2.0);
  EXPECT_NEAR(line.seeded({0.7, 1, 0}, 1.9).t, 0.7, 1e-14);
  const CurveProjector ring(circle({}, 1.0, k_full_turn));
  EXPECT_NEAR(ring.seeded({std::cos(0.1), std::sin(0.1), 0.5}, 6.2).distance, 0.5, 1e-13);
}

}  // namespace
}  // namespace sterna
