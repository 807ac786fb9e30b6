// Deflected control surfaces: the clean wing at zero, unchanged points before the hinge, trailing edges at the rotated positions, closed solids.
#include "geom/model/deflection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "geom/base/error.h"
#include "geom/cad/aircraft_union.h"
#include "geom/cad/shape.h"
#include "geom/model/components.h"
#include "geom/model/model_measures.h"
#include "geom/model/section_rows.h"
#include "geom/model/set_controls.h"
#include "geom/model/smx.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"

namespace sterna {
namespace {

using testing::HasSubstr;

using test::k_degree;

Wing straight_wing() {
  Wing wing{.name = "wing", .is_symmetric = true, .trailing_edge = 0.0};
  for (const double y : {6.0, 0.0}) {
    WingSection s{.name = "y", .leading_edge = {0.0, y, 0.0}, .chord = 2.0};
    for (int i = 0; i <= 60; ++i) {
      const double a = 2.0 * M_PI * i / 60, x = 0.5 + 0.5 * std::cos(a);
      s.points.push_back({x, (i == 0 || i == 60 ? 0.0 : 0.24) * std::sqrt(x) * (1.0 - x) * (i <= 30 ? 1.0 : -1.0)});
    }
    s.points[30] = {0.0, 0.0};
    wing.sections.push_back(s);
  }
  return wing;
}

ControlSurface flap(double from, double to, double chord, ControlKind kind = ControlKind::trailing_edge) {
  return {.name = "Flap", .wing = "wing", .kind = kind, .hinge = {{from, chord}, {to, chord}}};
}

TEST(Deflection, ZeroAngleIsCleanWingToTheBit) {
  const Wing wing = straight_wing();
  Wing named = deflected(wing, {{flap(0.1, 0.3, 0.7), 0.0}});
  EXPECT_EQ(named.patches.size(), 1u);
  named.patches.clear();
  EXPECT_TRUE(named == wing);
  EXPECT_TRUE(deflected(wing, {}) == wing);
}

/// Checks that OpenCASCADE's check finds no faults.
void expect_valid(const Model& model) {
  for (const ErrorLocation& fault : cad::faults_of(*cad::shape_of(model, RunContext()))) ADD_FAILURE() << fault.what;
}

double area_of(const Model& model, const std::string& name, FaceRole role) {
  double area = 0.0;
  for (const FaceId f : model.faces.ids())
    if (model.faces[f].name == name && model.faces[f].role == role) area += face_measures(model, f).area;
  return area;
}

TEST(Deflection, ZeroAngleNamesPatchesOfTheSameWing) {
  Wing wing = straight_wing();
  for (const std::optional<double> thickness : {std::optional<double>(0.0), std::optional<double>(0.02)})
    for (const bool is_cubic : {false, true}) {
      wing = straight_wing();
      wing.trailing_edge = thickness;
      wing.is_cubic = is_cubic;
      wing.sections.insert(wing.sections.begin() + 1, wing.sections[1]);
      wing.sections[1].leading_edge = {0.2, 2.5, 0.1};
      wing.sections[1].chord = 1.9;
      const SolidMeasures clean = solid_measures(make_wing(wing), SolidId(0));
      ControlSurface slat = flap(0.05, 0.4, 0.15, ControlKind::leading_edge), tip = flap(0.8, 1.02, 0.0, ControlKind::all_moving), kinked = flap(0.1, 0.3, 0.7);
      kinked.hinge.insert(kinked.hinge.begin() + 1, {0.27, 0.75});
      slat.name = "Slat";
      tip.name = "Tip";
      ControlSurface next = flap(0.3, 0.45, 0.8);
      next.name = "Next";  // begins where the flap ends
      const Model model = make_wing(deflected(wing, {{kinked}, {slat}, {tip}, {next}}));
      EXPECT_TRUE(free_edges(model).empty());
      const SolidMeasures m = solid_measures(model, SolidId(0));
      EXPECT_LT(m.open, 1e-9);
      expect_valid(model);
      EXPECT_NEAR(m.volume, clean.volume, 1e-9 * clean.volume);
      EXPECT_NEAR(m.area, clean.area, 1e-9 * clean.area);
      for (const char* name : {"Flap", "Slat", "Tip", "Next"}) EXPECT_GT(area_of(model, name, FaceRole::control), 0.3) << name;
      if (*thickness > 0.0) {
        EXPECT_NEAR(area_of(model, "Flap", FaceRole::trailing_edge), 0.02 * 2.4, 1e-3);
      }
    }
}

TEST(Deflection, EndsNearASectionAreThere) {
  Wing wing = straight_wing();
  wing.sections.insert(wing.sections.begin() + 1, wing.sections[1]);
  wing.sections[1].leading_edge = {0.0, 3.0, 0.0};
  for (const ControlKind kind : {ControlKind::trailing_edge, ControlKind::all_moving}) {
    const Wing named = deflected(wing, {{flap(0.25 - 3e-5, 0.5 + 1e-7, 0.7, kind)}});
    EXPECT_EQ(named.patches.at(0).border.front().section, 1.0);
    EXPECT_EQ(named.patches[0].border.back().section, 2.0);
    const Model model = make_wing(named);
    for (const FaceId f : model.faces.ids()) EXPECT_GT(face_measures(model, f).area, 0.02);
  }
}

TEST(Deflection, PatchCoversItsPartOfThePlanform) {
  const Model model = make_wing(deflected(straight_wing(), {{flap(0.1, 0.3, 0.7)}}));
  double area = 0.0;  // area of the upper side in plan view
  for (const FaceId f : model.faces.ids())
    if (model.faces[f].name == "Flap") area += std::max(0.0, face_measures(model, f).vector_area.z);
  EXPECT_NEAR(area, 0.2 * 12.0 * 0.3 * 2.0, 1e-6);
}

TEST(Deflection, MirrorImagesTurnAlikeOrOpposite) {
  const Wing wing = straight_wing();
  for (const OtherSide side : {OtherSide::none, OtherSide::same, OtherSide::opposite}) {
    const Model model = make_wing(deflected(wing, {{.surface = flap(0.1, 0.3, 0.7), .angle = 0.3, .other_side = side}}));
    EXPECT_LT(solid_measures(model, SolidId(0)).open, 1e-6);
    const double right = area_of(model, "Flap", FaceRole::control), left = area_of(model, "FlapLeft", FaceRole::control);
    EXPECT_GT(right, 1.0);
    EXPECT_NEAR(left, side == OtherSide::none ? 0.0 : right, 1e-9);
    double lowest = 0.0, highest = 0.0;
    for (const ModelCorner& corner : model.corners) {
      if (corner.point.y > 0.0) continue;
      lowest = std::min(lowest, corner.point.z);
      highest = std::max(highest, corner.point.z);
    }
    EXPECT_EQ(lowest < -0.15, side == OtherSide::same);
    EXPECT_EQ(highest > 0.15, side == OtherSide::opposite);
  }
}

TEST(Deflection, PositionsFromRootAreFractionsOfHalfSpan) {
  Wing wing = straight_wing();
  wing.sections.insert(wing.sections.begin() + 1, wing.sections[1]);
  wing.sections[1].leading_edge = {2.0, 2.0, 0.0};  // the inner part is swept, so its middle line is longer than its span
  ControlSurface aileron{.name = "Aileron", .wing = "wing", .hinge = {{0.5, 0.75}, {0.9, 0.7}}};
  aileron = from_root(wing, aileron);
  EXPECT_EQ(aileron.hinge[0].chord, 0.7);  // the outer end comes first
  const Model model = make_wing(deflected(wing, {{aileron}}));
  double low = 10.0, high = 0.0;
  for (const ModelEdge& edge : model.edges)
    if (edge.name == "hinge")
      for (const CornerId c : {edge.start, edge.end}) {
        low = std::min(low, model.corners[c].point.y);
        high = std::max(high, model.corners[c].point.y);
      }
  EXPECT_NEAR(low, 3.0, 1e-9);
  EXPECT_NEAR(high, 5.4, 1e-9);
}

TEST(Deflection, TheAircraftIsMadeWithThem) {
  Wing fin = straight_wing();
  fin.name = "RightFin";
  fin.is_symmetric = false;
  fin.has_mirror_image = true;
  Aircraft aircraft{.wings = {straight_wing(), fin}, .control_surfaces = {flap(0.6, 0.8, 0.8)}};
  aircraft.control_surfaces[0].name = "Tab";
  ControlSurface rudder = flap(0.2, 0.6, 0.7);
  rudder.name = "RightRudder";
  rudder.wing = "RightFin";
  aircraft.deflections = {{.surface = flap(0.1, 0.3, 0.7), .angle = 0.2}, {.surface = rudder, .angle = 0.2, .other_side = OtherSide::opposite}};
  const Model model = make_components(aircraft, RunContext());
  EXPECT_TRUE(free_edges(model).empty());
  for (const char* name : {"Flap", "Tab", "RightRudder", "LeftRudder"}) EXPECT_GT(area_of(model, name, FaceRole::control), 0.5) << name;
  aircraft.deflections[0].surface.wing = "none";
  test::expect_error(ErrorCode::bad_argument, "there is no wing 'none'\n  try: one of '", [&] { (void)make_components(aircraft, RunContext()); });
}

TEST(Deflection, FlapTurnsOnlyBehindKneeAndBetweenFairings) {
  const Wing wing = straight_wing();
  const double angle = 20.0 * k_degree;
  const Wing bent = deflected(wing, {{flap(0.1, 0.3, 0.7), angle}});
  const std::vector<Point> clean = wing_rows(wing).rows.front();
  int n_full = 0, n_clean = 0;
  for (const WingSection& section : bent.sections) {
    const double span = (6.0 - section.loop[k_wing_side_points].y) / 12.0;
    std::vector<Point> row = section.loop;
    if (span > 0.1 - 1e-9 && span < 0.3 + 1e-9) {
      ++n_full;  // hinge at x = 1.4, trailing edge 0.6 behind the hinge
      EXPECT_NEAR(row.front().x, 1.4 + 0.6 * std::cos(angle), 1e-9);
      EXPECT_NEAR(row.front().z, -0.6 * std::sin(angle), 1e-9);
    }
    const bool is_outside = span < 0.1 - 0.1 * 2.0 / 12.0 - 1e-9 || span > 0.3 + 0.1 * 2.0 / 12.0 + 1e-9;
    if (is_outside) ++n_clean;
    for (std::size_t k = 0; k < row.size(); ++k)
      if (is_outside || clean[k].x < 0.5 * 1.4) {
        EXPECT_NEAR(row[k].x, clean[k].x, 1e-14);  // rows between sections are interpolated: rounding only
        EXPECT_NEAR(row[k].z, clean[k].z, 1e-14);
      }
  }
  EXPECT_EQ(n_full, 2);
  EXPECT_GE(n_clean, 3);  // right tip, center, left tip
}

TEST(Deflection, WingsStayClosedAndKeepTheirVolumeNearly) {
  const Wing wing = straight_wing();
  const double volume = solid_measures(make_wing(wing), SolidId(0)).volume;
  for (const ControlKind kind : {ControlKind::trailing_edge, ControlKind::leading_edge, ControlKind::all_moving})
    for (const double angle : {-25.0, 10.0, 35.0}) {
      const Model model = make_wing(deflected(wing, {{flap(-0.02, 0.3, kind == ControlKind::leading_edge ? 0.2 : 0.7, kind), angle * k_degree, 0.3}}));
      EXPECT_TRUE(free_edges(model).empty());
      const SolidMeasures m = solid_measures(model, SolidId(0));
      EXPECT_LT(m.open, 1e-6);
      EXPECT_NEAR(m.volume, volume, 0.03 * volume);
      EXPECT_GT(area_of(model, "Flap", FaceRole::control), 0.5);
      if (angle > 30.0) expect_valid(model);  // OpenCASCADE's check is slow
    }
}

TEST(Deflection, CubicWingsBendBetweenSmoothRows) {
  Wing wing = straight_wing();
  wing.is_cubic = true;
  wing.sections.insert(wing.sections.begin() + 1, 2, wing.sections[1]);
  wing.sections[0].leading_edge = {1.5, 6.0, 0.4};
  wing.sections[1].leading_edge = {0.5, 4.0, 0.1};
  wing.sections[2].leading_edge = {0.1, 2.0, 0.0};
  const SolidMeasures clean = solid_measures(make_wing(wing), SolidId(0));
  // An angle of practically zero: the difference is the error of the rows.
  const Model sampled = make_wing(deflected(wing, {{.surface = flap(0.1, 0.3, 0.7), .angle = 1e-9}}));
  EXPECT_NEAR(solid_measures(sampled, SolidId(0)).volume, clean.volume, 1e-5 * clean.volume);
  EXPECT_NEAR(solid_measures(sampled, SolidId(0)).area, clean.area, 1e-5 * clean.area);
  const Model bent = make_wing(deflected(wing, {{.surface = flap(0.1, 0.3, 0.7), .angle = 0.3, .other_side = OtherSide::opposite}}));
  EXPECT_LT(solid_measures(bent, SolidId(0)).open, 1e-6);
  EXPECT_NEAR(solid_measures(bent, SolidId(0)).volume, clean.volume, 0.03 * clean.volume);
  expect_valid(bent);
}

TEST(Deflection, FlapAileronSlatAndTipAtOnce) {
  ControlSurface aileron = flap(0.12, 0.2, 0.75), slat = flap(0.1, 0.45, 0.15, ControlKind::leading_edge),
                 tip = flap(-0.02, 0.06, 0.0, ControlKind::all_moving);
  aileron.name = "Aileron";
  slat.name = "Slat";
  tip.name = "Tip";
  const Model model = make_wing(deflected(straight_wing(), {{.surface = flap(0.25, 0.45, 0.7), .angle = 0.5, .other_side = OtherSide::same},
                                                            {.surface = aileron, .angle = 0.2, .other_side = OtherSide::opposite},
                                                            {.surface = slat, .angle = 0.3, .other_side = OtherSide::same},
                                                            {.surface = tip, .angle = 0.1, .other_side = OtherSide::none}}));
  EXPECT_LT(solid_measures(model, SolidId(0)).open, 1e-6);
  expect_valid(model);
  for (const char* name : {"Flap", "FlapLeft", "Aileron", "AileronLeft", "Slat", "SlatLeft", "Tip"})
    EXPECT_GT(area_of(model, name, FaceRole::control), 0.3) << name;
}

Deflection open_flap(ControlSurface surface, double angle = 0.0) {
  return {.surface = std::move(surface), .angle = angle, .gap = ControlGap::open, .slot = 0.03, .end_gap = 0.05};
}

double volume_of(const Model& model, std::size_t solid) { return solid_measures(model, SolidId(solid)).volume; }

TEST(Deflection, OpenGapMakesSeparateSolidBehindCove) {
  for (const std::optional<double> thickness : {std::optional<double>(0.0), std::optional<double>(0.02)})
    for (const ControlKind kind : {ControlKind::trailing_edge, ControlKind::leading_edge})
      for (const bool is_flat : {false, true}) {
        Wing wing = straight_wing();
        wing.trailing_edge = thickness;
        const double clean = volume_of(make_wing(wing), 0);
        // The clean sections without slots: sections of the wing beside and before (behind) the hinge, and of the flap.
        Deflection d = open_flap(flap(0.1, 0.3, kind == ControlKind::leading_edge ? 0.2 : 0.7, kind));
        d.has_flat_nose = is_flat;
        const Model model = make_wing(deflected(wing, {d}));
        EXPECT_TRUE(free_edges(model).empty());
        ASSERT_EQ(model.solids.size(), 2u);
        for (const SolidId s : model.solids.ids()) EXPECT_LT(solid_measures(model, s).open, 1e-8);
        expect_valid(model);
        EXPECT_EQ(model.components[ComponentId(1)].name, "Flap");
        // Missing volume: the slots at both ends, and the cove's circle of radius r + slot less the nose's half circle (for a flat nose, the whole circle).
        const double chordwise = kind == ControlKind::leading_edge ? 0.2 : 0.3;
        const double r = 0.24 * std::sqrt(1.0 - (kind == ControlKind::leading_edge ? 0.8 : 0.3)) * (kind == ControlKind::leading_edge ? 0.8 : 0.3) * 2.0;
        const double length = 2.4, part = volume_of(model, 1);
        const double missing = clean - volume_of(model, 0) - part;
        const double half_nose = 0.5 * M_PI * r * r * (length - 0.1), half_cove = 0.5 * M_PI * (r + 0.03) * (r + 0.03) * length;
        EXPECT_GT(missing, 0.5 * (half_cove - half_nose));
        EXPECT_LT(missing, half_cove - (is_flat ? 0.0 : half_nose) + 0.1 * 2.0 * chordwise * 2.0 * r);
        EXPECT_NEAR(area_of(model, "Flap", FaceRole::control_side), area_of(model, "wing", FaceRole::control_side),
                    0.45 * area_of(model, "wing", FaceRole::control_side));
        EXPECT_GT(area_of(model, "Flap", FaceRole::hinge), 2.0 * r * 2.3 * 0.99);
        EXPECT_GT(area_of(model, "wing", FaceRole::hinge), 0.8 * area_of(model, "Flap", FaceRole::hinge));
        EXPECT_EQ(area_of(model, "wing", FaceRole::control), 0.0);
      }
}

TEST(Deflection, OpenFlapsTurnRigidlyClearOfWing) {
  Wing wing = straight_wing();
  wing.sections.insert(wing.sections.begin() + 1, wing.sections[1]);  // the flap extends across a section
  wing.sections[1].leading_edge = {0.0, 3.5, 0.0};
  const Model straight = make_wing(deflected(wing, {open_flap(flap(0.1, 0.3, 0.7))}));
  for (const double angle : {-20.0, 30.0}) {
    const Model turned = make_wing(deflected(wing, {open_flap(flap(0.1, 0.3, 0.7), angle * k_degree)}));
    expect_valid(turned);
    EXPECT_NEAR(volume_of(turned, 1), volume_of(straight, 1), 1e-9);
    EXPECT_NEAR(volume_of(turned, 0), volume_of(straight, 0), 1e-12);
    if (angle > 0.0) {
      EXPECT_EQ(cad::unite_aircraft(turned, {}, RunContext()).report.n_bodies, 2u);  // no bodies touch
    }
    double lowest = 0.0, highest = 0.0;
    for (const ModelCorner& corner : turned.corners)
      if (corner.point.x > 1.9) {
        lowest = std::min(lowest, corner.point.z);
        highest = std::max(highest, corner.point.z);
      }
    EXPECT_NEAR(angle > 0.0 ? lowest : -highest, -0.6 * std::sin(std::abs(angle) * k_degree), 0.02);
  }
}

TEST(Deflection, OpenAllMovingSurfacesAreCutOff) {
  for (const bool is_tip : {false, true}) {
    const Model model = make_wing(deflected(straight_wing(), {open_flap(flap(is_tip ? -0.02 : 0.1, 0.3, 0.25, ControlKind::all_moving), 10.0 * k_degree)}));
    EXPECT_TRUE(free_edges(model).empty());
    ASSERT_EQ(model.solids.size(), is_tip ? 2u : 3u);
    for (const SolidId s : model.solids.ids()) EXPECT_LT(solid_measures(model, s).open, 1e-8);
    expect_valid(model);
    EXPECT_GT(area_of(model, "Flap", FaceRole::control), 9.0);
    EXPECT_NEAR(area_of(model, "Flap", FaceRole::control_side), area_of(model, "wing", FaceRole::control_side), 1e-9);
    EXPECT_EQ(area_of(model, "Flap", FaceRole::tip) > 0.0, is_tip);
  }
}

TEST(Deflection, OpenAndSealedSurfacesOnOneMirroredWing) {
  ControlSurface aileron = flap(0.05, 0.2, 0.75), slat = flap(0.1, 0.45, 0.15, ControlKind::leading_edge), tab = flap(0.44, 0.48, 0.8);
  aileron.name = "Aileron";
  slat.name = "Slat";
  tab.name = "Tab";
  Deflection flaps = open_flap(flap(0.22, 0.42, 0.7), 0.5);
  flaps.other_side = OtherSide::same;
  const std::vector<Deflection> all{flaps,
                                    {.surface = aileron, .angle = 0.1, .fairing = 0.1, .other_side = OtherSide::opposite},
                                    {.surface = slat, .angle = 0.3, .other_side = OtherSide::same},
                                    {.surface = tab, .other_side = OtherSide::same}};
  Wing swept = straight_wing();
  swept.sections[0].leading_edge.x = 1.5;
  swept.sections[0].chord = 1.2;
  swept.sections[0].twist = -3.0 * k_degree;
  swept.sections[0].dihedral = 5.0 * k_degree;
  for (const Wing& wing : {straight_wing(), swept}) {
    const Model model = make_wing(deflected(wing, all));
    ASSERT_EQ(model.solids.size(), 3u);
    for (const SolidId s : model.solids.ids()) EXPECT_LT(solid_measures(model, s).open, 1e-6);
    expect_valid(model);
    EXPECT_NEAR(volume_of(model, 1), volume_of(model, 2), 1e-9);
    for (const char* name : {"Flap", "FlapLeft", "Aileron", "AileronLeft", "Slat", "SlatLeft", "Tab", "TabLeft"})
      EXPECT_GT(area_of(model, name, FaceRole::control), 0.1) << name;
  }
}

TEST(Deflection, AileronsOfTheWidebodyMoveApart) {
  STERNA_NEEDS_SHARED_DATA();
  const Aircraft aircraft = read_smx(test::shared_data() / "smx/widebody.smx", RunContext()).aircraft;
  const Wing& wing = aircraft.wings.at(0);
  std::vector<Deflection> deflections;
  for (const ControlSurface& surface : aircraft.control_surfaces)
    if (surface.wing == wing.name) deflections.push_back({surface, (deflections.empty() ? 15.0 : -15.0) * k_degree});
  ASSERT_EQ(deflections.size(), 2u);
  const Model model = make_wing(deflected(wing, deflections));
  EXPECT_TRUE(free_edges(model).empty());
  EXPECT_LT(solid_measures(model, SolidId(0)).open, 1e-6);
  expect_valid(model);
  deflections[0].gap = ControlGap::open;
  test::expect_error(ErrorCode::bad_argument, "deviates from the middle of the wing section by",
                     [&] { (void)deflected(wing, deflections); });  // the control surface extends across a kink of the wing
}

TEST(Deflection, FairingReachingFlatTipBendsIt) {
  Wing fin = straight_wing();
  fin.is_symmetric = false;
  fin.sections[0].leading_edge = {2.5, 6.0, 0.0};
  fin.sections[0].chord = 1.0;
  fin.right_tip = fin.left_tip = {CapShape::strip, 0.0};
  for (const std::optional<double> thickness : {std::optional<double>(0.0), std::optional<double>(0.02)}) {
    fin.trailing_edge = thickness;
    const Model model = make_wing(deflected(fin, {{.surface = flap(0.01, 0.95, 0.7), .angle = 0.3}}));
    EXPECT_TRUE(free_edges(model).empty());
    EXPECT_LT(solid_measures(model, SolidId(0)).open, 1e-9);
    expect_valid(model);
    EXPECT_GT(area_of(model, "wing", FaceRole::tip), 0.1);
  }
}

TEST(Deflection, RudderOfBjetWithOpenGap) {
  STERNA_NEEDS_SHARED_DATA();
  const Aircraft aircraft = read_smx(test::shared_data() / "smx/bjet.smx", RunContext()).aircraft;
  const auto fin = std::find_if(aircraft.wings.begin(), aircraft.wings.end(), [](const Wing& wing) { return wing.name == "Fin"; });
  const auto rudder =
      std::find_if(aircraft.control_surfaces.begin(), aircraft.control_surfaces.end(), [](const ControlSurface& s) { return s.name == "Rudder"; });
  ASSERT_TRUE(fin != aircraft.wings.end() && rudder != aircraft.control_surfaces.end());
  const Model model = make_wing(deflected(*fin, {{.surface = *rudder, .angle = 20.0 * k_degree, .gap = ControlGap::open}}));
  EXPECT_TRUE(free_edges(model).empty());
  ASSERT_EQ(model.solids.size(), 2u);
  for (const SolidId s : model.solids.ids()) EXPECT_LT(solid_measures(model, s).open, 1e-6);
  expect_valid(model);
}

TEST(Deflection, ImpossibleDeflectionsAreRefusedByName) {
  const Wing wing = straight_wing();
  const auto error_of = [&](const Wing& w, const std::vector<Deflection>& d) -> std::string {
    try {
      deflected(w, d);
    } catch (const Error& e) {
      return e.what();
    }
    ADD_FAILURE() << "no error";
    return {};
  };
  EXPECT_THAT(error_of(wing, {{flap(0.1, 0.3, 0.7), 1.5}}), HasSubstr("the limit is 60 degrees"));
  EXPECT_THAT(error_of(wing, {{flap(0.3, 0.1, 0.7), 0.1}}), HasSubstr("not in ascending order"));
  EXPECT_THAT(error_of(wing, {{flap(0.1, 0.3, 0.7), 0.1}, {flap(0.3, 0.4, 0.7), 0.2}}), HasSubstr("overlaps 'Flap'"));
  EXPECT_THAT(error_of(wing, {open_flap(flap(-0.1, 0.3, 0.7))}), HasSubstr("before the wing tips"));
  EXPECT_THAT(error_of(wing, {open_flap(flap(0.1, 0.3, 0.99))}), HasSubstr("0.03 and 0.97"));
  EXPECT_THAT(error_of(wing, {open_flap(flap(0.1, 0.3, 0.7)), open_flap(flap(0.302, 0.4, 0.7))}), HasSubstr("overlaps 'Flap'"));
  Deflection wide = open_flap(flap(0.1, 0.3, 0.7));
  wide.slot = 2.0;
  EXPECT_THAT(error_of(wing, {wide}), HasSubstr("larger than the remaining part"));
  Wing gull = wing;
  gull.sections.insert(gull.sections.begin() + 1, gull.sections[1]);
  gull.sections[1].leading_edge = {0.0, 3.5, 0.5};
  EXPECT_THAT(error_of(gull, {open_flap(flap(0.1, 0.3, 0.7))}), HasSubstr("deviates from the middle of the wing section"));
  ControlSurface other = flap(0.1, 0.3, 0.7);
  other.wing = "tail";
  EXPECT_THAT(error_of(wing, {{other, 0.1}}), HasSubstr("belongs to wing 'tail'"));
}

std::string error_of_settings(const Aircraft& aircraft, const std::vector<ControlSetting>& settings) {
  return test::error_of([&] { (void)with_controls_set(aircraft, settings); }).what();
}

TEST(SetControls, NeighboursMakeRoomAndStayClosed) {
  Aircraft aircraft{.name = "a", .wings = {straight_wing()}};
  for (const auto& [name, from, to] : {std::tuple{"Inner", 0.1, 0.25}, std::tuple{"Outer", 0.25, 0.4}, std::tuple{"Tab", 0.4, 0.45}})
    aircraft.control_surfaces.push_back({.name = name, .wing = "wing", .hinge = {{from, 0.7}, {to, 0.8}}});
  const Aircraft turned = with_controls_set(aircraft, {{.names = "Inner", .angle = 0.3}, {.names = "Out*", .angle = -0.2}});
  ASSERT_EQ(turned.deflections.size(), 3u);
  const auto of = [&](const std::string& name) { return *std::ranges::find(turned.deflections, name, [](const Deflection& d) { return d.surface.name; }); };
  // A fairing of a tenth of the chord of 2 m is a sixtieth of the span of 12 m. Each end between the two flaps moves in by one fairing;
  // beside the tab, which is not deflected, the outer flap also moves in by a whole fairing.
  const double fairing = 1.0 / 60.0;
  EXPECT_NEAR(of("Inner").surface.hinge.back().span, 0.25 - fairing, 1e-6);
  EXPECT_NEAR(of("Outer").surface.hinge.front().span, 0.25 + fairing, 1e-6);
  EXPECT_NEAR(of("Outer").surface.hinge.back().span, 0.4 - fairing, 1e-6);
  EXPECT_EQ(of("Tab").surface.hinge.front().span, 0.4);
  EXPECT_NEAR(of("Inner").surface.hinge.back().chord, 0.7 + 0.1 * (0.15 - fairing) / 0.15, 1e-6);  // on its hinge line
  const Model model = make_components(turned, RunContext());
  EXPECT_LT(solid_measures(model, SolidId(0)).open, 1e-6);
  EXPECT_GT(area_of(model, "Inner", FaceRole::control), 1.0);
}

TEST(SetControls, ControlsOfBjetMoveSegmentsByFactors) {
  STERNA_NEEDS_SHARED_DATA();
  const Aircraft bjet = read_smx(test::shared_data() / "smx" / "bjet.smx", RunContext()).aircraft;
  const Aircraft turned =
      with_controls_set(bjet, {{.names = "Aileron", .angle = 0.1}, {.names = "Flap", .angle = 0.2}, {.names = "RightElevator", .angle = 0.05}});
  std::map<std::string, double> angles;
  for (const Deflection& d : turned.deflections) angles[d.surface.name] = d.angle;
  EXPECT_EQ(angles, (std::map<std::string, double>{{"LeftAileronSegment0", -0.1},
                                                   {"LeftAileronSegment1", 0.2},
                                                   {"LeftElevator", 0.0},
                                                   {"RightAileronSegment0", 0.2},
                                                   {"RightAileronSegment1", 0.1},
                                                   {"RightElevator", 0.05}}));
  const Model model = make_components(turned, RunContext());
  for (const SolidId s : model.solids.ids()) EXPECT_LT(solid_measures(model, s).open, 1e-5) << model.solids[s].name;
  EXPECT_EQ(with_controls_set(bjet, {}).deflections, bjet.deflections);
}

TEST(SetControls, SegmentsThatTurnAlikeAreOneSurface) {
  STERNA_NEEDS_SHARED_DATA();
  const Aircraft plane = read_smx(test::shared_data() / "smx" / "widebody.smx", RunContext()).aircraft;
  for (const auto& [control, expected] : {std::pair{"LowSpeedRudder", "Rudder"}, std::pair{"HighSpeedAileron", "RightAileronSegment0"},
                                          std::pair{"LowSpeedAileron", "RightAileronSegment2"}, std::pair{"RightAileronSegment1", "RightAileronSegment1"}})
    for (const ControlGap gap : {ControlGap::sealed, ControlGap::open}) {
      SCOPED_TRACE(std::string(control) + (gap == ControlGap::open ? ", open" : ", sealed"));
      if (gap == ControlGap::open && std::string_view(control) == "LowSpeedRudder") continue;  // this control surface extends to the tip
      const Aircraft turned = with_controls_set(plane, {{.names = control, .angle = 0.2, .gap = gap}});
      EXPECT_TRUE(std::ranges::any_of(turned.deflections, [&](const Deflection& d) { return d.surface.name == expected && d.angle != 0.0; }));
      const Model model = make_components(turned, RunContext());
      for (const SolidId s : model.solids.ids()) EXPECT_LT(solid_measures(model, s).open, 1e-4) << model.solids[s].name;
    }
}

TEST(SetControls, UnknownControlsAreRefusedWithKnownNames) {
  Aircraft aircraft{.name = "a", .wings = {straight_wing()}};
  EXPECT_THAT(error_of_settings(aircraft, {{.names = "Flap", .angle = 0.1}}), HasSubstr("describes no control surfaces"));
  aircraft.control_surfaces.push_back(flap(0.1, 0.3, 0.7));
  aircraft.controls.push_back({"High lift", {{"Flap", 1.0}}});
  EXPECT_THAT(error_of_settings(aircraft, {{.names = "Flop", .angle = 0.1}}), HasSubstr("did you mean \"Flap\"?"));
  EXPECT_THAT(error_of_settings(aircraft, {{.names = "Flap", .angle = 0.1}, {.names = "F*", .angle = 0.1}}), HasSubstr("is already set by \"Flap\""));
  EXPECT_THAT(error_of_settings(aircraft, {{.names = "High lift", .angle = 0.1}, {.names = "Flap", .angle = 0.1}}),
              HasSubstr("is already set by \"High lift\""));
}

}  // namespace
}  // namespace sterna
