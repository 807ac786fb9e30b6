// Analytic surfaces, swept surfaces, views, curves.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/spline.h"
#include "geom/model/swept_surfaces.h"
#include "tests/geom/model/evaluator_checks.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"

namespace sterna {
namespace {

using test::k_pi;
const Frame k_frame = frame_along({0.3, -0.2, 1.0}, {1.0, 2.0, 0.5}, {0.0, 0.0, 1.0});

std::vector<Point> wave(int n, double z) {
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) points.push_back({0.5 * i, std::sin(0.7 * i) + 3.0, z + 0.1 * i});
  return points;
}

TEST(Frame, TransformsComposeInvertAndKnowThemselves) {
  const Transform t = rotation({1, 2, 3}, {0.2, 1, -0.5}, 0.7) * scaling({1, 0, 0}, 2.5) * mirroring({0, 1, 0}, {1, 1, 0}) * translation({4, 5, 6});
  const Point p{0.3, -7, 2};
  EXPECT_LE(distance(t.inverse().point(t.point(p)), p), 1e-14 * 10);
  EXPECT_TRUE(t.is_similarity());
  EXPECT_NEAR(t.determinant(), -2.5 * 2.5 * 2.5, 1e-12);
  EXPECT_NEAR(t.scale(), 2.5, 1e-14);
  EXPECT_LE(distance(rotation({}, {0, 0, 1}, k_pi / 2).point({1, 0, 0}), {0, 1, 0}), 1e-16);
  EXPECT_FALSE((Transform{{1, 0, 0}, {0, 2, 0}, {0, 0, 1}, {}}).is_similarity());
  test::expect_error(ErrorCode::bad_argument, "the direction (0, 0, 0) has no length", [&] { (void)mirroring({}, {}); });
  test::expect_error(ErrorCode::bad_argument, "the factor is -1.000000, must be positive", [&] { (void)scaling({}, -1.0); });
}

TEST(AnalyticSurfaces, SatisfyTheirEquations) {
  const CylinderSurface cylinder(k_frame, 0.7, {k_full_turn, {-1, 2}});
  const ConeSurface cone(k_frame, 0.5, 0.3, {k_full_turn, {0, 2}});
  const SphereSurface sphere(k_frame, 1.3);
  const TorusSurface torus(k_frame, 2.0, 0.4);
  for (double u = 0.0; u < 6.2; u += 0.37)
    for (double v = -1.5; v < 1.5; v += 0.21) {
      const Vec3 a = k_frame.local(cylinder.point({u, v})), b = k_frame.local(cone.point({u, v})), c = k_frame.local(sphere.point({u, v})),
                 d = k_frame.local(torus.point({u, v}));
      EXPECT_NEAR(std::hypot(a.x, a.y), 0.7, 1e-14);
      EXPECT_NEAR(a.z, v, 1e-14);
      EXPECT_NEAR(std::hypot(b.x, b.y), 0.5 + b.z * std::tan(0.3), 1e-14);
      EXPECT_NEAR(norm(c), 1.3, 1e-14);
      EXPECT_NEAR(std::hypot(std::hypot(d.x, d.y) - 2.0, d.z), 0.4, 1e-14);
      // Gaussian curvature of the sphere and mean curvature, from the second derivatives.
      const SurfaceDerivatives s = sphere.derivatives({u, v});
      const Vec3 n = normalized(cross(s.du, s.dv));
      EXPECT_NEAR(dot(n, normalized(s.point - k_frame.origin)), 1.0, 1e-12);
      const double e = dot(s.du, s.du), f = dot(s.du, s.dv), g = dot(s.dv, s.dv), l = dot(n, s.duu), m = dot(n, s.duv), k = dot(n, s.dvv);
      EXPECT_NEAR((l * k - m * m) / (e * g - f * f), 1.0 / (1.3 * 1.3), 1e-10);
    }
  for (const Surface* s : {static_cast<const Surface*>(&cylinder), static_cast<const Surface*>(&cone), static_cast<const Surface*>(&sphere),
                           static_cast<const Surface*>(&torus)}) {
    test::expect_derivatives(*s);
    EXPECT_TRUE(s->is_periodic_u());
    EXPECT_FALSE(s->exact_nurbs());
  }
  EXPECT_TRUE(torus.is_periodic_v());
  EXPECT_FALSE(CylinderSurface(k_frame, 1.0, {{0, 1}, {0, 1}}).is_periodic_u());
  const PlaneSurface plane(k_frame, {{-1, 2}, {0, 5}});
  test::expect_derivatives(plane, 5);
  test::expect_exact_nurbs(plane);
  test::expect_error(ErrorCode::bad_argument, "the radius is -1.000000 m, must be positive", [&] { (void)CylinderSurface(k_frame, -1.0, {{0, 1}, {0, 1}}); });
  test::expect_error(ErrorCode::bad_argument, "covers more than one turn: 7.000000 rad", [&] { (void)SphereSurface(k_frame, 1.0, {{0, 7}, {0, 1}}); });
  test::expect_error(ErrorCode::bad_argument, "the half angle is 0.000000 rad, must be between 0 and pi/2", [&] {
    (void)ConeSurface(k_frame, 1.0, 0.0, {{0, 1}, {0, 1}});
  });
}

TEST(Curves, LinesArcsAndViews) {
  const CurvePtr line = segment({1, 2, 3}, {4, 6, 3});
  EXPECT_DOUBLE_EQ(line->domain().to, 5.0);
  test::expect_exact_nurbs(*line);
  const EllipseCurve ellipse(k_frame.origin, 2.0 * k_frame.x, 0.5 * k_frame.y, k_full_turn);
  EXPECT_TRUE(ellipse.is_periodic());
  EXPECT_FALSE(ellipse.exact_nurbs());
  test::expect_derivatives(ellipse);
  for (double t = 0; t < 6; t += 0.3) {
    const Vec3 p = k_frame.local(ellipse.point(t));
    EXPECT_NEAR(p.x * p.x / 4 + p.y * p.y / 0.25, 1.0, 1e-14);
  }
  const CurvePtr spline = spline_curve(wave(9, 0.0), {.tangents = SplineTangents::akima});
  for (const CurvePtr& view :
       {part_of(spline, {0.2, 0.7}), reparametrised(spline, {-3, 4}), reversed(spline), reversed(part_of(reparametrised(spline, {1, 2}), {1.3, 1.9}))}) {
    test::expect_derivatives(*view);
    test::expect_exact_nurbs(*view);
    const auto form = view->exact_nurbs();
    const std::vector<double> a = view->breaks(), b = NurbsCurve(*form).breaks();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-13);
  }
  EXPECT_LE(distance(reversed(spline)->point(0.0), spline->point(1.0)), 1e-15);
  test::expect_error(ErrorCode::bad_argument, "[0.500000, 1.500000] is not within the parameter range [0.000000, 1.000000]", [&] {
    (void)part_of(spline, {0.5, 1.5});
  });
  EXPECT_NO_THROW(part_of(std::make_shared<EllipseCurve>(ellipse), {5.0, 7.0}));
  test::expect_error(ErrorCode::bad_argument, "(1, 0, 0) and (1, 1, 0) have no length or are not at right angles", [&] {
    (void)EllipseCurve({}, {1, 0, 0}, {1, 1, 0}, k_full_turn);
  });
  test::expect_error(ErrorCode::bad_argument, "the ends coincide at (1, 1, 1)", [&] { (void)segment({1, 1, 1}, {1, 1, 1}); });
}

TEST(Curves, ParameterCurves) {
  const ParameterCurvePtr line = parameter_segment({1, 2}, {3, 1}, {5, 7});
  EXPECT_NEAR(line->point(5).u, 1.0, 1e-15);
  EXPECT_NEAR(line->point(7).v, 1.0, 1e-15);
  EXPECT_NEAR(line->derivatives(6).first.u, 1.0, 1e-15);
  EXPECT_EQ(line->exact_nurbs()->poles.size(), 2u);
  const ParameterArc arc({0, 1}, {2, 0}, {0, 2}, {0, k_pi});
  EXPECT_NEAR(arc.point(k_pi / 2).v, 3.0, 1e-15);
  EXPECT_NEAR(arc.derivatives(0).first.v, 2.0, 1e-15);
  EXPECT_FALSE(arc.exact_nurbs());
}

TEST(SweptSurfaces, RevolutionOfALineIsTheCylinder) {
  const RevolutionSurface turned(segment({2, 0, 0}, {2, 0, 3}), {}, {0, 0, 2}, k_full_turn);
  const CylinderSurface cylinder({}, 2.0, {k_full_turn, {0, 3}});
  for (double u = 0; u < 6.2; u += 0.3) EXPECT_LE(distance(turned.point({u, 1.7}), cylinder.point({u, 1.7})), 1e-14);
  EXPECT_TRUE(turned.is_periodic_u());
  test::expect_derivatives(RevolutionSurface(spline_curve(wave(7, 1.0), {}), {0, 1, 0}, {1, 0.2, 0}, {0.1, 2.0}));
}

TEST(SweptSurfaces, ExtrusionAndRuledHaveTheirExactForm) {
  const CurvePtr a = spline_curve(wave(7, 0.0), {.tangents = SplineTangents::akima}), b = spline_curve(wave(12, 2.0), {}), line = segment({0, 0, 5}, {3, 1, 5});
  const ExtrusionSurface extrusion(a, {0.1, 0.2, 1.0}, {-1, 2});
  test::expect_derivatives(extrusion);
  test::expect_exact_nurbs(extrusion);
  for (const auto& [p, q] : {std::pair{a, b}, std::pair{a, line}, std::pair{line, b}, std::pair{line, segment({0, 0, 0}, {1, 1, 1})}}) {
    const RuledSurface ruled(p, q);
    test::expect_derivatives(ruled);
    test::expect_exact_nurbs(ruled);
    EXPECT_LE(distance(ruled.point({1.0, 0.0}), p->point(p->domain().to)), 1e-14);
    EXPECT_LE(distance(ruled.point({0.0, 1.0}), q->point(q->domain().from)), 1e-14);
  }
  EXPECT_FALSE(ExtrusionSurface(circle(k_frame, 1.0, k_full_turn), {0, 0, 1}, {0, 1}).exact_nurbs());
}

TEST(SurfaceView, PartsReversalsAndExchangesAreTheSameSurface) {
  PointGrid grid{8, 6, {}};
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 6; ++j) grid.points.push_back({1.0 * i, 0.8 * j, std::sin(0.5 * i) * std::cos(0.4 * j)});
  const SurfacePtr base = spline_surface(grid, {.tangents = SplineTangents::akima}, {});
  const SurfacePtr part = part_of(base, {{0.2, 0.9}, {0.3, 0.5}});
  for (const SurfacePtr& view : {part, reparametrised(part, {{-5, 5}, {1, 3}}), reversed_u(part), reversed_v(base), exchanged(part),
                                 exchanged(reversed_u(reparametrised(part, {{0, 4}, {0, 2}})))}) {
    test::expect_derivatives(*view, 30);
    test::expect_exact_nurbs(*view);
    test::expect_batch(*view);
    const NurbsSurface nurbs(*view->exact_nurbs());
    ASSERT_EQ(view->breaks_u().size(), nurbs.breaks_u().size());
    ASSERT_EQ(view->breaks_v().size(), nurbs.breaks_v().size());
  }
  EXPECT_LE(distance(exchanged(base)->point({0.3, 0.6}), base->point({0.6, 0.3})), 1e-15);
  EXPECT_LE(distance(reversed_u(base)->point({0.25, 0.6}), base->point({0.75, 0.6})), 1e-15);
  test::expect_error(ErrorCode::bad_argument, "u in [0.200000, 1.200000] is not within the parameter range", [&] {
    (void)part_of(base, {{0.2, 1.2}, {0.3, 0.5}});
  });
  // A part may extend across the seam of a periodic surface.
  const SurfacePtr cylinder = std::make_shared<CylinderSurface>(Frame{}, 1.0, ParameterBox{k_full_turn, {0, 1}});
  const SurfacePtr across = part_of(cylinder, {{5.0, 8.0}, {0.0, 1.0}});
  EXPECT_FALSE(across->is_periodic_u());
  EXPECT_TRUE(reparametrised(cylinder, {{0, 1}, {0, 1}})->is_periodic_u());
}

}  // namespace
}  // namespace sterna
