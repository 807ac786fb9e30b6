// Parametric shapes: volumes by formula, names, closedness.
#include "geom/model/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/model/components.h"
#include "geom/model/model_measures.h"

namespace sterna {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

void expect_closed(const Model& model) {
  EXPECT_TRUE(free_edges(model).empty());
  for (const SolidId s : model.solids.ids()) EXPECT_LT(solid_measures(model, s).open, 1e-9);
}

TEST(Shapes, box_and_cylinder_have_their_volumes) {
  const Model box = make_box("b", {-1.0, 2.0, 0.0}, {1.0, 5.0, 4.0});
  expect_closed(box);
  EXPECT_EQ(box.faces.size(), 6u);
  EXPECT_EQ(box.edges.size(), 12u);
  EXPECT_NEAR(solid_measures(box, SolidId(0)).volume, 24.0, 1e-12);
  const Model cylinder = make_cylinder("c", {1.0, 1.0, 1.0}, {3.0, 2.0, 3.0}, 0.5);
  expect_closed(cylinder);
  EXPECT_NEAR(solid_measures(cylinder, SolidId(0)).volume, pi * 0.25 * 3.0, 1e-9);
  EXPECT_NEAR(solid_measures(cylinder, SolidId(0)).area, 2 * pi * 0.5 * 3.0 + 2 * pi * 0.25, 1e-9);
  EXPECT_THROW(make_box("flat", {0, 0, 0}, {1, 1, 0}), Error);
  EXPECT_THROW(make_cylinder("flat", {0, 0, 0}, {0, 0, 0}, 1.0), Error);
}

TEST(Shapes, a_test_section_holds_the_fluid_inside) {
  TestSectionOptions o;
  o.length = 6.0;
  o.width = 2.1;
  o.height = 1.5;
  const Model plain = make_test_section(o);
  expect_closed(plain);
  EXPECT_NEAR(solid_measures(plain, SolidId(0)).volume, -6.0 * 2.1 * 1.5, 1e-10);  // normals look inwards, into the fluid
  o.contraction_length = 2.0;
  o.contraction_ratio = 4.0;
  o.diffuser_length = 3.0;
  o.diffuser_angle = 0.05;
  const Model tunnel = make_test_section(o);
  expect_closed(tunnel);
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

TEST(Shapes, required_options_are_asked_for_by_name) {
  try {
    make_test_section({});
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("width"));
  }
}

TEST(Shapes, nacelle_and_pylon_join_a_wing) {
  NacelleOptions n;
  n.length = 3.6;
  n.diameter = 2.1;
  const Body nacelle = nacelle_body("engine", {3.0, 5.0, -2.0}, n);
  const Model model = make_body(nacelle, ComponentKind::nacelle);
  expect_closed(model);
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
  expect_closed(solid);
  EXPECT_EQ(solid.components[ComponentId(0)].kind, ComponentKind::pylon);
  EXPECT_THROW(pylon_wing("pylon", wing, nacelle_body("far", {0.0, 50.0, 0.0}, n), {}), Error);
}

}  // namespace
}  // namespace sterna
