// Components as closed solids: volumes and areas against formulas, shared edges, names and roles, all real files.
#include "geom/model/components.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "geom/base/error.h"
#include "geom/cad/shape.h"
#include "geom/model/cpacs.h"
#include "geom/model/model_measures.h"
#include "geom/model/section_rows.h"
#include "geom/model/smx.h"
#include "geom/model/winglet_blend.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

/// Checks that every edge is used twice, in opposite directions; borders close in (u, v) and in space; parameter curves follow edges; vector areas cancel.
void expect_closed(const Model& model, double relative_tolerance = 1e-8) {
  const auto uses = uses_of_edges(model);
  for (const EdgeId e : model.edges.ids()) {
    if (model.edges[e].is_degenerate()) continue;
    ASSERT_EQ(uses[e].size(), 2u);
    const auto direction = [&](const EdgeUseLocation& p) {
      return model.faces[p.face].borders[p.border][p.location].is_reversed != model.faces[p.face].is_reversed;
    };
    EXPECT_NE(direction(uses[e][0]), direction(uses[e][1])) << model.edges[e].name;
  }
  for (const ModelFace& face : model.faces) {
    EXPECT_FALSE(face.name.empty());
    for (const Border& border : face.borders)
      for (std::size_t i = 0; i < border.size(); ++i) {
        const auto end_of = [&](const EdgeUse& use, bool last) {
          return use.parameter->point(last != use.is_reversed ? use.parameter->domain().to : use.parameter->domain().from);
        };
        const Uv a = end_of(border[i], true), b = end_of(border[(i + 1) % border.size()], false);
        EXPECT_LT(std::hypot(a.u - b.u, a.v - b.v), 1e-9) << face.name;
        const ModelEdge& edge = model.edges[border[i].edge];
        for (int k = 0; k <= 20 && !edge.is_degenerate(); ++k) {
          const double t = edge.range.from + edge.range.length() * k / 20.0;
          EXPECT_LT(distance(edge.curve->point(t), face.surface->point(border[i].parameter->point(t))), 1e-9 * (1.0 + norm(edge.curve->point(t)))) << face.name;
        }
      }
  }
  for (const SolidId s : model.solids.ids()) {
    const SolidMeasures m = solid_measures(model, s);
    EXPECT_GT(m.volume, 0.0) << model.solids[s].name;
    EXPECT_LT(m.open, relative_tolerance) << model.solids[s].name;
    EXPECT_TRUE(model.solids[s].is_closed);
  }
}

BodyFrame round_frame(double x, double radius) { return {.name = "x" + std::to_string(x), .center = {x, 0.0, 0.0}, .height = 2 * radius, .width = 2 * radius}; }

Body cylinder_body(double radius, double length) {
  Body body{.name = "Tube"};
  for (const double x : {0.0, 0.3, 0.7, 1.0}) body.frames.push_back(round_frame(x * length, radius));
  return body;
}

/// Returns two half ellipses as an airfoil: the area is pi / 4 * thickness * chord.
WingSection elliptic_section(double y, double chord, double thickness) {
  WingSection s{.name = "y" + std::to_string(y), .leading_edge = {0.0, y, 0.0}, .chord = chord};
  for (int i = 0; i <= 200; ++i) {
    const double a = 2 * pi * i / 200;
    s.points.push_back({0.5 + 0.5 * std::cos(a), 0.5 * thickness * std::sin(a)});
  }
  return s;
}

TEST(Components, TubeHasItsVolumeFlatOrDomed) {
  Body body = cylinder_body(0.8, 5.0);
  const Model flat = make_body(body, ComponentKind::body);
  expect_closed(flat);
  // A circle through 64 points as a cubic spline is off by 5e-7 of the radius at most.
  EXPECT_NEAR(solid_measures(flat, SolidId(0)).volume, pi * 0.64 * 5.0, 2e-6 * pi * 0.64 * 5.0);
  EXPECT_NEAR(solid_measures(flat, SolidId(0)).area, 2 * pi * 0.8 * 5.0 + 2 * pi * 0.64, 2e-5);
  EXPECT_EQ(flat.faces.size(), 4u);
  body.nose = body.tail = {CapShape::dome, 1.0};
  const Model domed = make_body(body, ComponentKind::body);
  expect_closed(domed);
  EXPECT_NEAR(solid_measures(domed, SolidId(0)).volume, pi * 0.64 * 5.0 + 4.0 / 3.0 * pi * 0.512, 1e-4);  // half spheres
  EXPECT_EQ(domed.faces.size(), 6u);
  body.nose = body.tail = {CapShape::strip, 1.0};
  const Model strips = make_body(body, ComponentKind::body);
  expect_closed(strips);
  EXPECT_NEAR(solid_measures(strips, SolidId(0)).volume, pi * 0.64 * 5.0 + 4.0 / 3.0 * pi * 0.512, 2e-4);  // half spheres again, built across the axis
  EXPECT_EQ(strips.faces.size(), 4u);
  for (const ErrorLocation& fault : cad::faults_of(*cad::shape_of(strips, RunContext()))) ADD_FAILURE() << fault.what;
}

TEST(Components, SuperellipsesDoubleEllipsesAndEggsFillTheirBox) {
  for (const FrameShape shape : {FrameShape::ellipse, FrameShape::double_ellipse, FrameShape::egg}) {
    Body body = cylinder_body(1.0, 4.0);
    for (BodyFrame& frame : body.frames) {
      frame.shape = shape;
      frame.width = 3.0;
      frame.exponent = 4.0;
      frame.offset = frame.distortion = 0.3;
    }
    const Model model = make_body(body, ComponentKind::body);
    expect_closed(model);
    const double area = solid_measures(model, SolidId(0)).volume / 4.0 / (3.0 * 2.0);
    // Share of the bounding box: the ellipse of exponent 4 has gamma(5/4)^2 / gamma(3/2), two half ellipses of any heights pi / 4.
    const double expected = shape == FrameShape::ellipse ? std::pow(std::tgamma(1.25), 2) / std::tgamma(1.5) : pi / 4;
    EXPECT_NEAR(area, expected, shape == FrameShape::ellipse ? 3e-4 : shape == FrameShape::double_ellipse ? 1e-5 : 0.03);
  }
}

TEST(Components, InletLipEndsInFlatFanFace) {
  Body body = cylinder_body(1.0, 4.0);
  body.lip = InletLip{0.5, 0.25, 1.0};
  const Model model = make_body(body, ComponentKind::nacelle, {"EngineIntake", "EngineExhaust"});
  expect_closed(model);
  int n_fan = 0;
  for (const FaceId f : model.faces.ids()) {
    const ModelFace& face = model.faces[f];
    if (face.role == FaceRole::fan_face) {
      ++n_fan;
      EXPECT_EQ(face.name, "EngineIntake");
      const FaceMeasures m = face_measures(model, f);
      EXPECT_NEAR(m.area, pi * 0.75 * 0.75, 1e-5);
      EXPECT_NEAR(m.vector_area.x, -m.area, 1e-9);  // the normal points forwards
    }
    if (face.role == FaceRole::nozzle) {
      EXPECT_EQ(face.name, "EngineExhaust");
    }
  }
  EXPECT_EQ(n_fan, 1);
  EXPECT_LT(solid_measures(model, SolidId(0)).volume, pi * 4.0);
}

TEST(Components, StraightWingHasVolumeAndAreaOfSections) {
  Wing wing{.name = "W", .sections = {elliptic_section(3.0, 2.0, 0.2), elliptic_section(0.0, 2.0, 0.2)}, .trailing_edge = std::nullopt};
  wing.right_tip = wing.left_tip = {CapShape::strip, 0.0};
  const Model model = make_wing(wing);
  expect_closed(model);
  EXPECT_NEAR(solid_measures(model, SolidId(0)).volume, 3.0 * pi / 4 * 2.0 * 0.4, 2e-4);
  EXPECT_EQ(model.faces.size(), 4u);  // upper, lower, two tips: the trailing edge is sharp
}

TEST(Components, RoundTipsAddHalfEllipsesSymmetricWingsMirror) {
  Wing wing{.name = "W", .is_symmetric = true, .sections = {elliptic_section(3.0, 2.0, 0.2), elliptic_section(0.0, 2.0, 0.2)}, .trailing_edge = std::nullopt};
  wing.right_tip = wing.left_tip = {CapShape::strip, 1.0};
  const Model model = make_wing(wing);
  expect_closed(model);
  // Each tip: half an ellipsoid with half axes 1 (chord), 0.2, 0.2.
  EXPECT_NEAR(solid_measures(model, SolidId(0)).volume, 6.0 * pi / 4 * 2.0 * 0.4 + 4.0 / 3.0 * pi * 1.0 * 0.2 * 0.2, 4e-4);
  Vec3 first_moment;
  for (const FaceId f : model.faces.ids())
    if (model.faces[f].role == FaceRole::tip) first_moment += face_measures(model, f).vector_area;
  EXPECT_NEAR(first_moment.y, 0.0, 1e-12);
}

TEST(Components, BluntTrailingEdgeIsFaceOfGivenThickness) {
  Wing wing{.name = "W", .sections = {elliptic_section(0.0, 2.0, 0.2), elliptic_section(3.0, 2.0, 0.2)}, .trailing_edge = 0.01};
  for (const double height : {0.0, 1.0}) {
    wing.right_tip = wing.left_tip = {CapShape::strip, height};
    const Model model = make_wing(wing);
    expect_closed(model);
    double area = 0.0;
    for (const FaceId f : model.faces.ids())
      if (model.faces[f].role == FaceRole::trailing_edge) area += face_measures(model, f).area;
    EXPECT_NEAR(area, 3.0 * 0.01 + (height > 0.0 ? pi * 0.005 * 0.005 : 0.0), 1e-9);
  }
}

TEST(Components, CubicWingsAreOneFaceBetweenBreaks) {
  Wing wing{.name = "W", .is_symmetric = true, .is_cubic = true, .trailing_edge = 0.0};
  for (const double y : {4.0, 3.0, 1.5, 0.0}) wing.sections.push_back(elliptic_section(y, 2.0 - 0.05 * y * y, 0.2));
  const Model smooth = make_wing(wing);
  expect_closed(smooth);
  EXPECT_EQ(smooth.faces.size(), 2u * 2u + 2u);
  wing.sections[1].is_break = true;
  const Model broken = make_wing(wing);
  expect_closed(broken);
  EXPECT_EQ(broken.faces.size(), 4u * 2u + 2u);
}

double turn_between(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

TEST(Components, WingletsJoinRound) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"smx/bjet.smx", "smx/torture.smx", "smx/widebody.smx"}) {
    Wing wing = read_smx(test::shared_data() / name, RunContext()).aircraft.wings.at(0);
    ASSERT_TRUE(wing.has_winglet);
    const WingRows round = wing_rows(wing);
    EXPECT_EQ(round.rows.size(), 2 * wing.sections.size() - 1 + 2 * k_winglet_rows) << name;
    const Model model = make_wing(wing);
    expect_closed(model, 1e-6);
    for (const ErrorLocation& fault : cad::faults_of(*cad::shape_of(model, RunContext()))) ADD_FAILURE() << name << ": " << fault.what;
    // The leading edge, seen along x, continues in the same direction at both ends of the blend; without the blend it bends by 30 degrees and more.
    std::vector<Vec3> starts, ends;
    for (const ModelEdge& edge : model.edges)
      if (edge.name == "leading edge") {
        const auto direction = [&](double t) {
          const Vec3 d = edge.curve->derivatives(t).first;
          return Vec3{0.0, d.y, d.z};
        };
        starts.push_back(direction(edge.range.from));
        ends.push_back(direction(edge.range.to));
      }
    EXPECT_LT(turn_between(ends[0], starts[1]), 0.06) << name;
    EXPECT_LT(turn_between(ends[1], starts[2]), 0.06) << name;
    wing.has_winglet = false;
    const double straight = solid_measures(make_wing(wing), SolidId(0)).area;
    EXPECT_NEAR(solid_measures(model, SolidId(0)).area, straight, 0.02 * straight) << name;
  }
  const Wing plain = read_smx(test::shared_data() / "smx/delta.smx", RunContext()).aircraft.wings.at(0);
  EXPECT_EQ(wing_rows(plain).rows.size(), 2 * plain.sections.size() - 1);  // this wing has no winglet
}

TEST(Components, SectionWithOnlyNacaDesignationIsMade) {
  Wing wing{.name = "W", .trailing_edge = 0.0};
  for (const double y : {3.0, 0.0}) wing.sections.push_back({.name = "s", .leading_edge = {0.0, y, 0.0}, .chord = 2.0, .naca = "0012"});
  wing.right_tip = wing.left_tip = {CapShape::strip, 0.0};
  const Model model = make_wing(wing);
  expect_closed(model);
  // Area of the 4-digit section: 5 t (0.2969 / 1.5 - 0.126 / 2 - 0.3516 / 3 + 0.2843 / 4 - 0.1015 / 5) on both sides, times the chord squared; minus the wedge
  // that closes the section.
  EXPECT_NEAR(solid_measures(model, SolidId(0)).volume, 3.0 * 4.0 * (2.0 * 0.6 * (0.2969 / 1.5 - 0.063 - 0.1172 + 0.071075 - 0.0203) - 0.00126), 3e-3);
}

TEST(Components, MirrorImageHasSameVolumeAndOtherName) {
  Wing wing{.name = "RightFin", .sections = {elliptic_section(1.0, 2.0, 0.2), elliptic_section(3.0, 1.0, 0.2)}, .trailing_edge = 0.0};
  wing.has_mirror_image = true;
  Aircraft aircraft;
  aircraft.wings.push_back(wing);
  const Model model = make_components(aircraft, RunContext());
  expect_closed(model);
  ASSERT_EQ(model.solids.size(), 2u);
  EXPECT_EQ(model.solids[SolidId(1)].name, "LeftFin");
  EXPECT_NEAR(solid_measures(model, SolidId(0)).volume, solid_measures(model, SolidId(1)).volume, 1e-12);
  aircraft.wings[0].name = "fin";
  EXPECT_EQ(make_components(aircraft, RunContext()).solids[SolidId(1)].name, "finLeft");
}

TEST(Components, ErrorsNameTheFrame) {
  Body body = cylinder_body(1.0, 4.0);
  body.frames[2].center.x = body.frames[1].center.x;
  body.frames[2].name = "Odd";
  try {
    make_body(body, ComponentKind::body);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::bad_argument);
    EXPECT_THAT(e.what(), HasSubstr("'Odd' are not in ascending order along x"));
  }
}

class RealAircraft : public testing::TestWithParam<const char*> {};

TEST_P(RealAircraft, AllComponentsAreClosedSolids) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string name = GetParam();
  const auto path = test::shared_data() / name;
  const Aircraft aircraft = name.ends_with(".smx") ? read_smx(path, RunContext()).aircraft : read_cpacs(path, RunContext()).aircraft;
  const Model model = make_components(aircraft, RunContext());
  EXPECT_GE(model.solids.size(), aircraft.bodies.size() + aircraft.wings.size() + aircraft.nacelles.size());
  expect_closed(model, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(files, RealAircraft,
                         testing::Values("smx/bjet.smx", "smx/delta.smx", "smx/torture.smx", "smx/underwingnacelle.smx", "smx/utility.smx", "smx/widebody.smx",
                                         "cpacs/CPACS_30_D150.xml", "cpacs/boxWing.xml", "cpacs/canards.xml", "cpacs/d150.xml", "cpacs/landingGears.xml",
                                         "cpacs/nacelles.xml", "cpacs/onera_m6.xml", "cpacs/simpletest-flaps.cpacs.xml", "cpacs/simpletest-halfmodel.cpacs.xml",
                                         "cpacs/simpletest-nacelle.xml", "cpacs/simpletest-pylon-nacelle.cpacs.xml", "cpacs/simpletest.cpacs.xml"),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

}  // namespace
}  // namespace sterna
