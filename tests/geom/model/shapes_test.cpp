// Parametric shapes: volumes by formula, names, closedness.
#include "geom/model/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/cad/shape.h"
#include "geom/model/components.h"
#include "geom/model/model_measures.h"
#include "tests/support/error_of.h"

namespace sterna {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

void expect_no_opening(const Model& model) {
  EXPECT_TRUE(free_edges(model).empty());
  for (const SolidId s : model.solids.ids()) EXPECT_LT(solid_measures(model, s).open, 1e-9);
}

TEST(Shapes, BoxAndCylinderHaveTheirVolumes) {
  const Model box = make_box("b", {-1.0, 2.0, 0.0}, {1.0, 5.0, 4.0});
  expect_no_opening(box);
  EXPECT_EQ(box.faces.size(), 6u);
  EXPECT_EQ(box.edges.size(), 12u);
  EXPECT_NEAR(solid_measures(box, SolidId(0)).volume, 24.0, 1e-12);
  const Model cylinder = make_cylinder("c", {1.0, 1.0, 1.0}, {3.0, 2.0, 3.0}, 0.5);
  expect_no_opening(cylinder);
  EXPECT_NEAR(solid_measures(cylinder, SolidId(0)).volume, pi * 0.25 * 3.0, 1e-9);
  EXPECT_NEAR(solid_measures(cylinder, SolidId(0)).area, 2 * pi * 0.5 * 3.0 + 2 * pi * 0.25, 1e-9);
  test::expect_error(ErrorCode::bad_argument, "box 'flat': the corners (0, 0, 0) and (1, 1, 0) must ascend", [&] {
    (void)make_box("flat", {0, 0, 0}, {1, 1, 0});
  });
  test::expect_error(ErrorCode::bad_argument, "cylinder 'flat': the cylinder is 0.000000 m long", [&] {
    (void)make_cylinder("flat", {0, 0, 0}, {0, 0, 0}, 1.0);
  });
}

TEST(Shapes, TestSectionHoldsFluidInside) {
  TestSectionOptions o;
  o.length = 6.0;
  o.width = 2.1;
  o.height = 1.5;
  const Model plain = make_test_section(o);
  expect_no_opening(plain);
  EXPECT_NEAR(solid_measures(plain, SolidId(0)).volume, -6.0 * 2.1 * 1.5, 1e-10);  // normals point inwards, into the fluid
  o.contraction_length = 2.0;
  o.contraction_ratio = 4.0;
  o.diffuser_length = 3.0;
  o.diffuser_angle = 0.05;
  const Model tunnel = make_test_section(o);
  expect_no_opening(tunnel);
  double inflow = 0.0, outflow = 0.0;
  for (const FaceId f : tunnel.faces.ids()) {
    if (tunnel.faces[f].role == FaceRole::inflow) inflow += face_measures(tunnel, f).area;
    if (tunnel.faces[f].role == FaceRole::outflow) outflow += face_measures(tunnel, f).area;
  }
  EXPECT_NEAR(inflow, 4.0 * 2.1 * 1.5, 1e-10);
  const double wider = 2 * 3.0 * std::tan(0.05);
  EXPECT_NEAR(outflow, (2.1 + wider) * (1.5 + wider), 1e-10);
  EXPECT_EQ(tunnel.components[ComponentId(0)].kind, ComponentKind::tunnel);
}

TEST(Shapes, RequiredOptionsAreNamed) {
  const auto error_of = [](const TestSectionOptions& options) -> std::string {
    try {
      make_test_section(options);
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of({}), HasSubstr("needs length"));
  EXPECT_THAT(error_of({.length = 4.0}), HasSubstr("give width and height, or the diameter"));
}

TEST(Shapes, NacelleAndPylonJoinAWing) {
  NacelleOptions n;
  n.length = 3.6;
  n.diameter = 2.1;
  const Body nacelle = nacelle_body("engine", {3.0, 5.0, -2.0}, n);
  const Model model = make_body(nacelle, ComponentKind::nacelle);
  expect_no_opening(model);
  double fan = 0.0;
  for (const FaceId f : model.faces.ids())
    if (model.faces[f].role == FaceRole::fan_face) fan = face_measures(model, f).area;
  EXPECT_NEAR(fan, pi / 4 * std::pow(0.78 * 2.1, 2), 1e-5);
  Wing wing{.name = "wing", .is_symmetric = true};
  for (const double y : {15.0, 0.0}) {
    WingSection s{.name = "s", .leading_edge = {4.0 + 0.3 * y, y, 0.0}, .chord = 5.0 - 0.2 * y};
    s.points = {{1.0, 0.0}, {0.7, 0.05}, {0.3, 0.06}, {0.0, 0.0}, {0.3, -0.06}, {0.7, -0.05}, {1.0, 0.0}};
    wing.sections.push_back(s);
  }
  const Wing pylon = pylon_wing("pylon", wing, nacelle, {});
  ASSERT_EQ(pylon.sections.size(), 2u);
  EXPECT_NEAR(pylon.sections[1].leading_edge.x, 4.0 + 0.3 * 5.0 + 0.1 * 4.0, 1e-9);
  for (const WingSection& section : pylon.sections) EXPECT_NEAR(section.leading_edge.y, 5.0, 1e-12);
  const Model solid = make_wing(pylon);
  expect_no_opening(solid);
  EXPECT_EQ(solid.components[ComponentId(0)].kind, ComponentKind::pylon);
  test::expect_error(ErrorCode::bad_argument, "nacelle 'far' is at y = 50.000000 m, where wing 'wing' has no section", [&] {
    (void)pylon_wing("pylon", wing, nacelle_body("far", {0.0, 50.0, 0.0}, n), {});
  });
}

/// Returns half the height of a nacelle's cowl; the contour is straight between frames.
double cowl_radius(const Body& nacelle, double x) {
  std::size_t i = 0;
  while (i + 2 < nacelle.frames.size() && x > nacelle.frames[i + 1].center.x) ++i;
  const BodyFrame &a = nacelle.frames[i], &b = nacelle.frames[i + 1];
  return 0.5 * (a.height + (x - a.center.x) / (b.center.x - a.center.x) * (b.height - a.height));
}

TEST(Shapes, PylonsStartAtCowlAndAvoidJet) {
  for (const double side : {1.0, -1.0})           // nacelle below the wing, then above
    for (const double behind : {-1.5, 0.0, 2.5})  // position of the wing
      for (const double to : {0.6, 0.95, 1.0, 1.3})
        for (const double exit : {0.4, 0.6, 0.8}) {
          NacelleOptions n;
          n.length = 4.0;
          n.diameter = 2.1;
          n.exit_ratio = exit;
          const Body nacelle = nacelle_body("engine", {}, n);
          Wing wing{.name = "wing"};
          for (const double y : {5.0, -5.0}) {
            WingSection s{.name = "s", .leading_edge = {behind, y, 1.6 * side}, .chord = 5.0};
            s.points = {{1.0, 0.0}, {0.7, 0.05}, {0.3, 0.06}, {0.0, 0.0}, {0.3, -0.06}, {0.7, -0.05}, {1.0, 0.0}};
            wing.sections.push_back(s);
          }
          PylonOptions o;
          o.nacelle_to = to;
          const Wing pylon = pylon_wing("pylon", wing, nacelle, o);
          const std::string label =
              "side " + std::to_string(side) + " behind " + std::to_string(behind) + " to " + std::to_string(to) + " exit " + std::to_string(exit);
          const std::vector<Point>&lower = pylon.sections[0].loop, &upper = pylon.sections[1].loop;
          double least = 1.0;
          for (std::size_t i = 0; i < lower.size(); ++i) {
            // The lower end is inside the cowl. Points behind the nozzle, and the lines from them to the wing, are above the jet.
            const double x = lower[i].x;
            if (x <= n.length && to <= 0.95) EXPECT_LT(std::hypot(lower[i].y, lower[i].z), cowl_radius(nacelle, x)) << label << " at x = " << x;
            for (int k = 0; k <= 50; ++k) {
              const Point p = lower[i] + (k / 50.0) * (upper[i] - lower[i]);
              if (p.x >= n.length) least = std::min(least, std::hypot(p.y, p.z) - cowl_radius(nacelle, n.length));
            }
          }
          EXPECT_GT(least, 0.0) << label;
        }
}

double volume_of(const Model& model) { return solid_measures(model, SolidId(0)).volume; }

Model valid(const Body& body) {
  const Model model = make_body(body, body.kind);
  expect_no_opening(model);
  for (const ErrorLocation& fault : cad::faults_of(*cad::shape_of(model, RunContext()))) ADD_FAILURE() << body.name << ": " << fault.what;
  return model;
}

TEST(Shapes, BoomIsTubeWithHalfEllipsoids) {
  BoomOptions o;
  o.diameter = 0.4;
  for (const Point& to : {Point{5.0, 0.0, 0.0}, Point{3.0, 4.0, 0.0}, Point{0.0, 0.0, -5.0}, Point{-3.0, 0.0, 4.0}}) {
    const Model boom = valid(boom_body("boom", {0.0, 0.0, 0.0}, to, o));
    EXPECT_NEAR(volume_of(boom), pi * 0.04 * (5.0 - 1.2) + 2.0 / 3.0 * pi * 0.04 * (0.4 + 0.8), 1e-5);
    EXPECT_EQ(boom.components[ComponentId(0)].kind, ComponentKind::boom);
    double farthest = 0.0;
    for (const ModelCorner& corner : boom.corners) farthest = std::max(farthest, dot(corner.point, to) / 5.0);
    EXPECT_NEAR(farthest, 5.0, 1e-5);  // ends at the given length, within the accuracy of the spline's circles
  }
  test::expect_error(ErrorCode::bad_argument, "shorter than the boom, 1.000000 m", [&] { (void)boom_body("short", {0, 0, 0}, {1, 0, 0}, o); });
  test::expect_error(ErrorCode::bad_argument, "shorter than the boom, 0.000000 m", [&] { (void)boom_body("none", {0, 0, 0}, {0, 0, 0}, o); });
}

TEST(Shapes, BodyOfRevolutionHasVolumeOfItsProfile) {
  // A cone and a cylinder are exact; a smooth profile r = 0.3 sin(pi x / 4) has the volume pi 0.09 / 2 * 4.
  EXPECT_NEAR(volume_of(valid(body_of_revolution("b", {}, {{0.0, 0.0}, {1.0, 0.5}, {3.0, 0.5}}, true))), pi * 0.25 * (1.0 / 3.0 + 2.0), 1e-5);
  std::vector<Uv> profile;
  for (int i = 0; i <= 24; ++i) profile.push_back({i / 6.0, i == 0 || i == 24 ? 0.0 : 0.3 * std::sin(pi * i / 24.0)});
  EXPECT_NEAR(volume_of(valid(body_of_revolution("s", {}, profile))), pi * 0.09 * 2.0, 2e-3 * pi * 0.09 * 2.0);
  const auto expect_refused = [](const std::string& problem, const std::vector<Uv>& profile_of_it) {
    test::expect_error(ErrorCode::bad_argument, problem, [&] { (void)body_of_revolution("bad", {}, profile_of_it); });
  };
  expect_refused("the profile has 1 points; at least 2 are needed", {{0.0, 1.0}});
  expect_refused("point 2 of the profile (x = 1, radius 0) needs a positive radius", {{0.0, 1.0}, {1.0, 0.0}, {2.0, 1.0}});
  expect_refused("point 2 of the profile (x = 0, radius 2) does not lie behind the point before it", {{0.0, 1.0}, {0.0, 2.0}});
  expect_refused("point 1 of the profile (x = 0, radius -1) needs a positive radius", {{0.0, -1.0}, {1.0, 1.0}});
}

TEST(Shapes, FairingFillsItsBox) {
  FairingOptions o;
  o.length = 6.0;
  o.width = 2.0;
  o.height = 1.0;
  o.exponent = 2.0;
  // Elliptic sections: half an ellipsoid in front, and pi / 4 w h (1 - t2)^2 behind, which is 8 / 15 of the cylinder.
  const Model model = valid(fairing_body("belly", {1.0, 0.0, -1.0}, o));
  EXPECT_NEAR(volume_of(model), pi / 4 * 2.0 * (0.4 * 6.0 * 2.0 / 3.0 + 0.6 * 6.0 * 8.0 / 15.0), 0.01);
  EXPECT_EQ(model.components[ComponentId(0)].kind, ComponentKind::fairing);
  o.exponent = 4.0;
  EXPECT_GT(volume_of(valid(fairing_body("belly", {1.0, 0.0, -1.0}, o))), 1.1 * volume_of(model));
}

TEST(Shapes, StingIsCylinderAndConeWithFlatEnds) {
  StingOptions o;
  o.diameter = 0.1;
  EXPECT_NEAR(volume_of(valid(sting_body("sting", {1.0, 0.0, 0.0}, {3.0, 0.0, 0.5}, o))), pi * 0.0025 * std::hypot(2.0, 0.5), 1e-7);
  o.cone_start = 1.0;
  o.end_diameter = 0.2;
  const Model model = valid(sting_body("sting", {1.0, 0.0, 0.0}, {4.0, 0.0, 0.0}, o));
  EXPECT_NEAR(volume_of(model), pi * (0.0025 + 2.0 / 3.0 * (0.0025 + 0.005 + 0.01)), 1e-6);
  int n_tails = 0;
  for (const ModelFace& face : model.faces) n_tails += face.role == FaceRole::tail;
  EXPECT_EQ(n_tails, 1);
  o.cone_start = 5.0;
  test::expect_error(ErrorCode::bad_argument, "the cone starts at 5.000000 m, but the sting is only 3.000000 m long", [&] {
    (void)sting_body("sting", {1.0, 0.0, 0.0}, {4.0, 0.0, 0.0}, o);
  });
}

}  // namespace
}  // namespace sterna
