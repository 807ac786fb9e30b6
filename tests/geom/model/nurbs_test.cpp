#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geom/base/error.h"
#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/nurbs_tools.h"
#include "tests/geom/model/evaluator_checks.h"

namespace sterna {
namespace {

std::vector<double> random_knots(int degree, int n_inner, std::mt19937_64& random, int multiplicity = 1) {
  std::uniform_real_distribution<double> step(0.05, 1.0);
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, -0.7);
  double t = -0.7;
  for (int i = 0; i < n_inner; ++i) {
    t += step(random);
    for (int k = 0; k < (i % 3 == 1 ? multiplicity : 1); ++k) knots.push_back(t);
  }
  t += step(random);
  knots.insert(knots.end(), static_cast<std::size_t>(degree) + 1, t);
  return knots;
}

NurbsCurveForm<Point> random_curve(int degree, int n_inner, bool is_rational, std::mt19937_64& random, int multiplicity = 1) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  NurbsCurveForm<Point> form{degree, random_knots(degree, n_inner, random, multiplicity), {}, {}};
  for (std::size_t i = 0; i + static_cast<std::size_t>(degree) + 1 < form.knots.size(); ++i) {
    form.poles.push_back({unit(random) + static_cast<double>(i), unit(random), unit(random)});
    if (is_rational) form.weights.push_back(1.5 + unit(random));
  }
  return form;
}

NurbsSurfaceForm random_surface(int p, int q, bool is_rational, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-0.3, 0.3);
  NurbsSurfaceForm form;
  form.degree_u = p;
  form.degree_v = q;
  form.knots_u = random_knots(p, 5, random, std::min(p, 2));
  form.knots_v = random_knots(q, 4, random);
  form.n_u = form.knots_u.size() - static_cast<std::size_t>(p) - 1;
  form.n_v = form.knots_v.size() - static_cast<std::size_t>(q) - 1;
  for (std::size_t i = 0; i < form.n_u; ++i)
    for (std::size_t j = 0; j < form.n_v; ++j) {
      form.poles.push_back({static_cast<double>(i) + unit(random), static_cast<double>(j) + unit(random), unit(random)});
      if (is_rational) form.weights.push_back(1.0 + unit(random));
    }
  return form;
}

/// Evaluates the curve with de Boor's algorithm by repeated corner cutting: the definition, independent of the basis functions.
Point by_corner_cutting(const NurbsCurveForm<Point>& form, double t) {
  const auto p = static_cast<std::size_t>(form.degree);
  std::size_t span = p;
  while (span + p + 2 < form.knots.size() && t >= form.knots[span + 1]) ++span;
  std::vector<Point> d;
  std::vector<double> w;
  for (std::size_t k = 0; k <= p; ++k) {
    w.push_back(form.weights.empty() ? 1.0 : form.weights[span - p + k]);
    d.push_back(w.back() * form.poles[span - p + k]);
  }
  for (std::size_t r = 1; r <= p; ++r)
    for (std::size_t k = p; k >= r; --k) {
      const double from = form.knots[span - p + k], to = form.knots[span + k - r + 1], a = (t - from) / (to - from);
      d[k] = (1 - a) * d[k - 1] + a * d[k];
      w[k] = (1 - a) * w[k - 1] + a * w[k];
    }
  return d[p] / w[p];
}

TEST(NurbsCurve, AgreesWithCornerCuttingForEveryDegree) {
  std::mt19937_64 random(1);
  for (const int degree : {1, 2, 3, 4, 5, 9, 25}) {
    for (const bool is_rational : {false, true}) {
      const NurbsCurve curve(random_curve(degree, 7, is_rational, random, std::min(degree, 2)));
      const Interval range = curve.domain();
      for (int i = 0; i <= 300; ++i) {
        const double t = range.from + range.length() * i / 300.0;
        EXPECT_LE(distance(curve.point(t), by_corner_cutting(curve.form(), t)), 1e-12) << degree << " at " << t;
      }
      if (degree > 1) test::expect_derivatives(curve);
    }
  }
}

TEST(NurbsCurve, EndsAreEndPolesAndEndPiecesContinue) {
  std::mt19937_64 random(2);
  const NurbsCurve curve(random_curve(3, 5, false, random));
  EXPECT_LE(distance(curve.point(curve.domain().from), curve.form().poles.front()), 1e-15);
  EXPECT_LE(distance(curve.point(curve.domain().to), curve.form().poles.back()), 1e-14);
  // A cubic equals its own Taylor series: the piece beyond the end has the same third difference.
  const double t = curve.domain().to, h = 0.01;
  const auto third = [&](double from) { return curve.point(from + 3 * h) - 3.0 * curve.point(from + 2 * h) + 3.0 * curve.point(from + h) - curve.point(from); };
  EXPECT_LE(distance(third(t - 3 * h), third(t)), 1e-12);
}

TEST(NurbsCurve, BreaksAreKnotsOfLowContinuity) {
  const NurbsCurve curve({3,
                          {0, 0, 0, 0, 1, 2, 2, 3, 3, 3, 4, 4, 4, 4},
                          std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {3, 0, 0}, {4, 0, 2}, {5, 0, 0}, {6, 0, 0}, {7, 3, 0}, {8, 0, 0}, {9, 0, 0}},
                          {}});
  EXPECT_EQ(curve.breaks(), (std::vector<double>{2.0, 3.0}));
}

TEST(NurbsCurve, RefusesFormsThatBreakTheRules) {
  const auto message = [](NurbsCurveForm<Point> form) -> std::string {
    try {
      NurbsCurve curve(std::move(form));
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  const std::vector<Point> two{{0, 0, 0}, {1, 0, 0}};
  EXPECT_THAT(message({1, {0, 0, 1}, two, {}}), testing::HasSubstr("too few"));
  EXPECT_THAT(message({1, {0, 0, 1, 0}, two, {}}), testing::HasSubstr("descend"));
  EXPECT_THAT(message({1, {0, 0.5, 1, 1}, two, {}}), testing::HasSubstr("not clamped"));
  EXPECT_THAT(message({1, {0, 0, 1, 1}, {{0, 0, 0}}, {}}), testing::HasSubstr("1 poles"));
  EXPECT_THAT(message({1, {0, 0, 1, 1}, two, {1.0, -1.0}}), testing::HasSubstr("weight 1"));
  EXPECT_THAT(message({26, {0, 0, 1, 1}, two, {}}), testing::HasSubstr("degree is 26"));
  EXPECT_THAT(message({1, {0, 0, 0.5, 0.5, 1, 1}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {}}), testing::HasSubstr("more than 1 times"));
}

TEST(NurbsSurface, DerivativesAndBatchForEveryPairOfDegrees) {
  std::mt19937_64 random(4);
  for (const int p : {1, 2, 3, 5})
    for (const int q : {1, 2, 3, 4})
      for (const bool is_rational : {false, true}) {
        const NurbsSurface surface(random_surface(p, q, is_rational, random));
        test::expect_derivatives(surface, 25);
        test::expect_batch(surface);
        // On a border, the surface equals the curve of the border poles.
        NurbsCurveForm<Point> border{p, surface.form().knots_u, {}, {}};
        for (std::size_t i = 0; i < surface.form().n_u; ++i) {
          border.poles.push_back(surface.form().poles[i * surface.form().n_v]);
          if (is_rational) border.weights.push_back(surface.form().weights[i * surface.form().n_v]);
        }
        const ParameterBox box = surface.domain();
        for (int i = 0; i <= 50; ++i) {
          const double u = box.u.from + box.u.length() * i / 50.0;
          EXPECT_LE(distance(surface.point({u, box.v.from}), by_corner_cutting(border, u)), 1e-13);
        }
      }
}

TEST(NurbsSurface, QuarterCylinderOfWeightsIsRound) {
  NurbsSurfaceForm form;
  form.degree_u = 2;
  form.knots_u = {0, 0, 0, 1, 1, 1};
  form.knots_v = {0, 0, 2, 2};
  form.n_u = 3;
  form.n_v = 2;
  form.poles = {{1, 0, 0}, {1, 0, 2}, {1, 1, 0}, {1, 1, 2}, {0, 1, 0}, {0, 1, 2}};
  const double w = std::numbers::sqrt2 / 2;
  form.weights = {1, 1, w, w, 1, 1};
  const NurbsSurface surface(form);
  EXPECT_EQ(surface.kind(), "NURBS 2 x 1");
  for (int i = 0; i <= 20; ++i) {
    const SurfaceDerivatives d = surface.derivatives({i / 20.0, 0.3});
    EXPECT_NEAR(std::hypot(d.point.x, d.point.y), 1.0, 1e-15);
    EXPECT_NEAR(d.point.z, 0.3, 1e-15);
    // Curvature of the circle: |r' x r''| / |r'|^3 = 1.
    EXPECT_NEAR(norm(cross(d.du, d.duu)) / std::pow(norm(d.du), 3), 1.0, 1e-12);
  }
}

TEST(NurbsTools, InsertionElevationRestrictionReversalKeepTheCurve) {
  std::mt19937_64 random(6);
  for (const int degree : {1, 2, 3, 5})
    for (const bool is_rational : {false, true}) {
      const NurbsCurveForm<Point> form = random_curve(degree, 6, is_rational, random, std::min(degree, 2));
      const NurbsCurve curve(form);
      const Interval range = curve.domain();
      std::vector<double> more = form.knots;
      more.insert(more.end(), {range.from + 0.1, range.from + 0.1234, range.to - 0.01});
      std::sort(more.begin(), more.end());
      const NurbsCurve inserted(on_knots(form, degree, more));
      const NurbsCurve elevated(on_knots(form, degree + 3, elevated_knots(form.knots, 3)));
      const Interval part{range.from + 0.21 * range.length(), range.from + 0.77 * range.length()};
      const NurbsCurve middle(restricted(form, part));
      const NurbsCurve backwards(reversed(form));
      EXPECT_EQ(middle.domain(), part);
      for (int i = 0; i <= 100; ++i) {
        const double t = range.from + range.length() * i / 100.0, s = part.from + part.length() * i / 100.0;
        EXPECT_LE(distance(curve.point(t), inserted.point(t)), 3e-14) << degree;
        EXPECT_LE(distance(curve.point(t), elevated.point(t)), 1e-13) << degree;
        EXPECT_LE(distance(curve.point(s), middle.point(s)), 1e-13) << degree;
        EXPECT_LE(distance(curve.point(t), backwards.point(-t)), 3e-14) << degree;
      }
    }
}

TEST(NurbsTools, SurfacesInBothDirections) {
  std::mt19937_64 random(8);
  const NurbsSurfaceForm form = random_surface(3, 2, true, random);
  const NurbsSurface surface(form);
  const ParameterBox box = surface.domain();
  const NurbsSurface elevated(on_knots_v(on_knots_u(form, 4, elevated_knots(form.knots_u, 1)), 4, elevated_knots(form.knots_v, 2)));
  const Interval pu{box.u.from + 0.3, box.u.to - 0.2}, pv{box.v.from + 0.1, box.v.to - 0.3};
  const NurbsSurface part(restricted(form, pu, pv));
  const NurbsSurface turned(exchanged(form)), back_u(reversed_u(form)), back_v(reversed_v(form));
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    const Uv at{pu.from + unit(random) * pu.length(), pv.from + unit(random) * pv.length()};
    const Point p = surface.point(at);
    EXPECT_LE(distance(p, elevated.point(at)), 1e-13);
    EXPECT_LE(distance(p, part.point(at)), 1e-13);
    EXPECT_LE(distance(p, turned.point({at.v, at.u})), 1e-14);
    EXPECT_LE(distance(p, back_u.point({-at.u, at.v})), 1e-13);
    EXPECT_LE(distance(p, back_v.point({at.u, -at.v})), 1e-13);
  }
}

TEST(NurbsParameterCurve, IsTheSameInThePlane) {
  const NurbsCurveForm<Uv> form{2, {0, 0, 0, 1, 1, 1}, {{0, 0}, {1, 2}, {2, 0}}, {}};
  const NurbsParameterCurve curve(form);
  EXPECT_NEAR(curve.point(0.5).v, 1.0, 1e-15);
  EXPECT_NEAR(curve.derivatives(0.5).first.u, 2.0, 1e-15);
  EXPECT_NEAR(curve.derivatives(0.0).first.v, 4.0, 1e-15);
}

}  // namespace
}  // namespace sterna
