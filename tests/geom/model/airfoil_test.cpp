#include "geom/model/airfoil.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "geom/base/error.h"
#include "tests/geom/model/evaluator_checks.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"

namespace sterna {
namespace {

using test::message_of;

/// Returns the distances of the points of `a` from the polyline of `b`.
std::vector<double> deviations(const Airfoil& a, const Airfoil& b) {
  std::vector<double> distances;
  for (const Uv p : a.points) {
    double least = 1e300;
    for (std::size_t i = 0; i + 1 < b.points.size(); ++i) {
      const Uv q = b.points[i], d = b.points[i + 1] - q;
      const double t = std::clamp(((p.u - q.u) * d.u + (p.v - q.v) * d.v) / (d.u * d.u + d.v * d.v), 0.0, 1.0);
      least = std::min(least, std::hypot(p.u - q.u - t * d.u, p.v - q.v - t * d.v));
    }
    distances.push_back(least);
  }
  return distances;
}
double deviation(const Airfoil& a, const Airfoil& b) {
  const std::vector<double> distances = deviations(a, b);
  return *std::max_element(distances.begin(), distances.end());
}

std::filesystem::path file(const char* name) { return test::shared_data() / "airfoils" / name; }

TEST(Airfoil, AllRealFilesAreRead) {
  STERNA_NEEDS_SHARED_DATA();
  int n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::shared_data() / "airfoils")) {
    if (entry.path().extension() != ".dat") continue;
    SCOPED_TRACE(entry.path().filename().string());
    ++n;
    const Airfoil airfoil = read_airfoil(entry.path());
    EXPECT_FALSE(airfoil.name.empty());
    EXPECT_GE(airfoil.points.size(), 30u);
    EXPECT_GT(airfoil.points[airfoil.leading_edge / 2].v, airfoil.points[airfoil.leading_edge + airfoil.leading_edge / 2].v);
    EXPECT_LT(airfoil.trailing_edge_thickness(), 0.01);
    const AirfoilMeasures m = measure(airfoil);
    EXPECT_GT(m.thickness, 0.05);
    EXPECT_LT(m.thickness, 0.19);
    const Repaneled repanel = repaneled_within(airfoil, 1e-4);
    EXPECT_LE(repanel.error, 1e-4);
    const Airfoil sharp = with_trailing_edge(airfoil, 0.0), unit = normalized(sharp);
    EXPECT_EQ(sharp.trailing_edge_thickness(), 0.0);
    const AirfoilCurves curves = airfoil_curves(unit);
    EXPECT_LE(norm(curves.upper->point(0.0)), 1e-12);
    EXPECT_LE(distance(curves.upper->point(0.0), curves.lower->point(0.0)), 1e-14);
    EXPECT_NEAR(curves.upper->point(1.0).x, 1.0, 1e-12);
    EXPECT_NEAR(curves.around->derivatives(curves.leading_edge).first.x, 0.0, 1e-9);
    test::expect_exact_nurbs(*curves.upper, 1e-12);
    test::expect_exact_nurbs(*curves.lower, 1e-12);
  }
  EXPECT_EQ(n, 27);
}

TEST(Airfoil, GeneratedSectionsAgreeWithPublishedCoordinates) {
  STERNA_NEEDS_SHARED_DATA();
  struct Case {
    const char *file, *name;
    double nine_of_ten, all;  // limits of the distances of the file's points from the generated airfoil: for 90 % of the points, and the largest
  };
  for (const Case& c :
       {// Formulas: the difference is the polyline's sagitta (3e-6 at the nose, with 400 points a side) and the files' last digit (5e-6 in the last two).
        Case{"n0012.dat", "0012", 2e-6, 4e-6}, Case{"naca0012.dat", "0012", 2e-6, 4e-6}, Case{"naca0006.dat", "NACA 0006", 5e-6, 6e-6},
        Case{"naca23012.dat", "naca23012", 8e-6, 1e-5},
        // Mapping: the tables of 1945, calculated by hand, against the functions of 1974. The largest 10 %: the nose of 63A210 (1.3e-4); for 66(3)-218 the
        // station 0.65 on both sides (2.0e-4).
        Case{"naca63a210.dat", "63A210", 8e-5, 1.4e-4}, Case{"naca663218.dat", "66(3)-218", 7e-5, 2.1e-4},
        // This file's nose (x < 0.025) is 2.5e-4 blunter than that of the mapping, which reproduces 64A010 to 4e-5.
        Case{"n64015a.dat", "642-015A", 2.3e-4, 2.6e-4},
        // This file closes the trailing edge, which by definition is 2.1e-4 from the middle.
        Case{"naca64a010.dat", "64-010A", 3e-5, 2.2e-4}}) {
    SCOPED_TRACE(c.file);
    std::vector<double> distances = deviations(read_airfoil(file(c.file)), naca_airfoil(c.name, 400));
    std::sort(distances.begin(), distances.end());
    EXPECT_LE(distances[distances.size() * 9 / 10], c.nine_of_ten);
    EXPECT_LE(distances.back(), c.all);
  }
}

TEST(Airfoil, NacaSectionsHaveThicknessAndCamberOfName) {
  struct Case {
    const char* name;
    double thickness, thickness_at, lift_or_camber;
  };
  for (const Case& c : {Case{"0012", 0.12, 0.30, 0}, Case{"2412", 0.12, 0.30, 0.02}, Case{"4418", 0.18, 0.30, 0.04}, Case{"0012-64", 0.12, 0.40, 0},
                        Case{"0010-35", 0.10, 0.50, 0}, Case{"23012", 0.12, 0.30, 0.018}, Case{"16-012", 0.12, 0.50, 0}, Case{"63-012", 0.12, 0.35, 0},
                        Case{"64-012", 0.12, 0.375, 0}, Case{"65-012", 0.12, 0.40, 0}, Case{"66-012", 0.12, 0.45, 0}, Case{"67-012", 0.12, 0.48, 0},
                        Case{"63A012", 0.12, 0.37, 0}, Case{"64A012", 0.12, 0.39, 0}, Case{"65A012", 0.12, 0.42, 0}}) {
    SCOPED_TRACE(c.name);
    const Airfoil airfoil = naca_airfoil(c.name, 120);
    const AirfoilMeasures m = measure(airfoil);
    EXPECT_NEAR(m.thickness, c.thickness, 6e-4);  // measured across the chord, not across the mean line
    EXPECT_NEAR(m.thickness_at, c.thickness_at, 0.035);
    EXPECT_NEAR(m.camber, c.lift_or_camber, 1e-3);
  }
  // The mean line of uniform load: camber cl ln 2 / (4 pi) in the middle.
  EXPECT_NEAR(measure(naca_airfoil("65-412", 120)).camber, 0.4 * std::log(2.0) / (4.0 * M_PI), 5e-4);
  // A reflexed mean line turns up at the trailing edge, for zero moment; a plain mean line does not.
  const Airfoil reflexed = naca_airfoil("23112", 120), plain = naca_airfoil("23012", 120);
  const auto mean_at_90 = [](const Airfoil& a) {
    const AirfoilCurves c = airfoil_curves(a);
    return 0.5 * (c.upper->point(0.9).z + c.lower->point(0.9).z);
  };
  EXPECT_LT(mean_at_90(reflexed), mean_at_90(plain));
  EXPECT_LE(deviation(naca_airfoil("65,3-618 a=0.5"), naca_airfoil("65(3)-618 a = 0.5", 400)), 2e-4);
  EXPECT_GT(deviation(naca_airfoil("65-618 a=0.5"), naca_airfoil("65-618", 400)), 1e-3);
}

/// 0012-63 is not 0012: TM-4741's modified sections have a cubic aft of the largest thickness (d0 = 0.002, d1 = 0.234, d2 = -0.068571, d3 = -0.093878 for 0.3
/// and t = 0.2) and another quadratic and cubic term ahead of it. By these formulas the two differ by 1.57e-3 at x = 0.633, and by 8.2e-4 at most ahead of 0.3.
TEST(Airfoil, ModifiedSectionsFollowTheirOwnFormula) {
  const Airfoil modified = naca_airfoil("0012-63", 400), plain = naca_airfoil("0012", 400);
  EXPECT_NEAR(deviation(modified, plain), 1.567e-3, 1e-5);  // distance normal to a side that slopes by 6 degrees at this station
  const auto aft = [](double x) { return 0.6 * (0.002 + (1.0 - x) * (0.234 + (1.0 - x) * (-0.068571 + (1.0 - x) * -0.093878))); };
  for (const Uv p : modified.points)
    if (p.u >= 0.3) {
      EXPECT_NEAR(std::abs(p.v), aft(p.u), 1e-6) << p.u;  // digits of d2 and d3
    }
  double ahead = 0.0;
  for (std::size_t i = 0; i < plain.points.size(); ++i)
    if (plain.points[i].u < 0.3) ahead = std::max(ahead, std::abs(plain.points[i].v - modified.points[i].v));
  EXPECT_NEAR(ahead, 8.16e-4, 1e-6);
}

TEST(Airfoil, DesignationsThatAreNoneAreRefused) {
  for (const char* bad : {"", "NACA", "12", "2012x", "62-215", "26012", "21112", "0000", "0099", "0012-68", "16-2", "63A", "2012-6", "67A210", "66A210"})
    EXPECT_THAT(message_of([&] { (void)naca_airfoil(bad); }), testing::HasSubstr("NACA airfoil")) << bad;
  EXPECT_THAT(message_of([] { (void)naca_airfoil("2012"); }), testing::HasSubstr("second digit is 0"));
}

TEST(Airfoil, LayoutsAreToldApart) {
  const std::string selig = "My section\n1.0 0.001\n0.5 0.06\n0.1 0.04\n0 0\n0.1 -0.03\n0.5 -0.04\n1 -0.001\n";
  const std::string lednicer = "My section\n 4. 4.\n\n0 0\n0.1 0.04\n0.5 0.06\n1.0 0.001\n\n0 0\n0.1 -0.03\n0.5 -0.04\n1 -0.001\n";
  const std::string no_counts = "My section\n0 0\n0.1 0.04\n0.5 0.06\n1.0 0.001\n0 0\n0.1 -0.03\n0.5 -0.04\n1 -0.001\n";
  const std::string lower_first = "My section\r\n1 -0.001\r\n0.5 -0.04\r\n0.1 -0.03\r\n0 0\r\n0.1 0.04\r\n0.5 0.06\r\n1.0 0.001\r\n";
  const std::string percent = "My section\n100.0 0.1\n50 6\n10 4\n0 0\n10 -3\n50 -4\n100 -0.1\n";
  const std::string remarks = "My section\nsecond line of text\nfrom TP-1\n\n# x z\n" + selig.substr(11);
  const Airfoil reference = parse_airfoil(selig, "reading");
  EXPECT_EQ(reference.name, "My section");
  EXPECT_EQ(reference.leading_edge, 3u);
  ASSERT_EQ(reference.points.size(), 7u);
  for (const std::string& text : {lednicer, no_counts, lower_first, percent, remarks}) {
    const Airfoil airfoil = parse_airfoil(text, "reading");
    EXPECT_EQ(airfoil.name, "My section");
    ASSERT_EQ(airfoil.points.size(), 7u) << text;
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_NEAR(airfoil.points[i].u, reference.points[i].u, 1e-15);
      EXPECT_NEAR(airfoil.points[i].v, reference.points[i].v, 1e-15);
    }
  }
}

TEST(Airfoil, BadFilesAreRefusedWithTheLine) {
  const auto message = [](const std::string& text) { return message_of([&] { (void)parse_airfoil(text, "reading airfoil bad.dat"); }); };
  using testing::HasSubstr;
  EXPECT_THAT(message(""), HasSubstr("empty"));
  EXPECT_THAT(message("name\nonly text\n"), HasSubstr("line 2: the file ends here and holds no points"));
  EXPECT_THAT(message("n\n5 5\n# nothing\n"), HasSubstr("line 3: 0 points"));
  EXPECT_THAT(message("n\n1 0\n0.5 0.1\n0 0\n0.5 abc\n1 0\n"), testing::AllOf(HasSubstr("line 5"), HasSubstr("0.5 abc")));
  EXPECT_THAT(message("n\n1 0\n0.5 0.1\n0 0\n0.5 -0.1 3\n1 0\n"), testing::AllOf(HasSubstr("line 5"), HasSubstr("3 numbers")));
  EXPECT_THAT(message("n\n1 0\n0.5 0.1\n0 0\n0.5 nan\n1 0\n"), HasSubstr("line 5"));
  EXPECT_THAT(message("n\n1 0\n0.5 0.1\n0 0\n"), HasSubstr("3 points"));
  EXPECT_THAT(message("n\n5 5\n0 0\n0.5 0.1\n1 0\n0 0\n0.5 -0.1\n1 0\n"), HasSubstr("5 + 5 points, the file holds 6"));
  EXPECT_THAT(message("n\n1 0\n0.5 0.1\n0.7 0.1\n0.3 0.1\n0 0\n0.5 -0.1\n1 0\n"), testing::AllOf(HasSubstr("line 4"), HasSubstr("turns back")));
  EXPECT_THAT(message("n\n0 0\n0.2 0.1\n0.5 0.1\n0.8 0.05\n1 0\n"), HasSubstr("do not run around"));
  EXPECT_THAT(message_of([] { (void)read_airfoil("/absent/a.dat"); }), HasSubstr("does not exist"));
  // Any prefix of a good file is either read or refused, without a crash.
  const std::string good = "n\n1.0 0.001\n0.5 0.06\n0.1 0.04\n0 0\n0.1 -0.03\n0.5 -0.04\n1 -0.001\n";
  for (std::size_t n = 0; n < good.size(); ++n) (void)message(good.substr(0, n));
}

TEST(Airfoil, TrailingEdgesOpenAndClose) {
  const Airfoil airfoil = naca_airfoil("2412");
  EXPECT_NEAR(airfoil.trailing_edge_thickness(), 0.00252, 2e-5);
  for (const double t : {0.0, 0.001, 0.00252, 0.005, 0.02}) {
    const Airfoil other = with_trailing_edge(airfoil, t);
    EXPECT_NEAR(other.trailing_edge_thickness(), t, 1e-5 * (1 + t)) << t;
    EXPECT_EQ(other.points[other.leading_edge], airfoil.points[airfoil.leading_edge]);
    // Both sides are rotated, not compressed: their lengths change by the motion of the ends along them. This is half the thickness times the mean line's slope
    // at the edge (2 m / (1 - p) = 1/15 for 2412).
    const double along = 0.5 * std::max(0.0, airfoil.trailing_edge_thickness() - t) / 15.0;
    const auto length = [](const Airfoil& a, Uv end) { return std::hypot(end.u - a.points[a.leading_edge].u, end.v - a.points[a.leading_edge].v); };
    if (t < airfoil.trailing_edge_thickness()) {
      EXPECT_NEAR(length(other, other.points.front()), length(airfoil, airfoil.points.front()) - along, 2e-6);  // second order in the thickness
      EXPECT_NEAR(length(other, other.points.back()), length(airfoil, airfoil.points.back()) + along, 2e-6);
    }
    EXPECT_LE(deviation(other, airfoil), 0.5 * std::abs(t - airfoil.trailing_edge_thickness()) + 1e-6);
    EXPECT_NEAR(0.5 * (other.points.front().v + other.points.back().v), 0.5 * (airfoil.points.front().v + airfoil.points.back().v), 1e-6);
  }
  EXPECT_EQ(with_trailing_edge(airfoil, 0.0).trailing_edge_thickness(), 0.0);
  test::expect_error(ErrorCode::bad_argument, "a thickness of -0.1 chords, must be 0 or more and below 0.2", [&] { (void)with_trailing_edge(airfoil, -0.1); });
  test::expect_error(ErrorCode::bad_argument, "a thickness of 0.3 chords, must be 0 or more and below 0.2", [&] { (void)with_trailing_edge(airfoil, 0.3); });
}

TEST(Airfoil, RepanelingKeepsItsBound) {
  const Airfoil airfoil = naca_airfoil("63-415", 150);
  double before = 1.0;
  for (const int n : {15, 30, 60, 120}) {
    const Repaneled r = repaneled(airfoil, n);
    EXPECT_EQ(r.airfoil.points.size(), 2u * static_cast<std::size_t>(n) + 1);
    EXPECT_LT(r.error, before);
    before = r.error;
  }
  for (const double tolerance : {1e-3, 1e-5, 1e-6}) EXPECT_LE(repaneled_within(airfoil, tolerance).error, tolerance);
  test::expect_error(ErrorCode::bad_argument, "3 points along a side, must be 5 .. 2000", [&] { (void)repaneled(airfoil, 3); });
  test::expect_error(ErrorCode::bad_argument, "the tolerance is 0 chords, must be positive", [&] { (void)repaneled_within(airfoil, 0.0); });
}

}  // namespace
}  // namespace sterna
