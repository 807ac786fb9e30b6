// Deflected control surfaces: the clean wing at zero, points before the hinge untouched, trailing edges where a turn puts them, closed solids.
#include "geom/model/deflection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geom/base/error.h"
#include "geom/model/components.h"
#include "geom/model/model_measures.h"
#include "geom/model/section_rows.h"
#include "geom/model/smx.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

using testing::HasSubstr;

constexpr double k_degree = 0.017453292519943295;

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

TEST(Deflection, no_angle_is_the_clean_wing_to_the_bit) {
  const Wing wing = straight_wing();
  EXPECT_TRUE(deflected(wing, {{flap(0.1, 0.3, 0.7), 0.0}}) == wing);
  EXPECT_TRUE(deflected(wing, {}) == wing);
}

TEST(Deflection, a_flap_turns_its_trailing_edge_and_nothing_before_the_knee_or_beside_the_fairing) {
  const Wing wing = straight_wing();
  const double angle = 20.0 * k_degree;
  const Wing bent = deflected(wing, {{flap(0.1, 0.3, 0.7), angle}});
  const std::vector<Point> clean = wing_rows(wing).rows.front();
  int n_full = 0, n_clean = 0;
  for (const WingSection& section : bent.sections) {
    const double span = (6.0 - section.loop[k_wing_side_points].y) / 12.0;
    std::vector<Point> row = section.loop;
    if (span > 0.1 - 1e-9 && span < 0.3 + 1e-9) {
      ++n_full;  // hinge at x = 1.4, the trailing edge 0.6 behind it
      EXPECT_NEAR(row.front().x, 1.4 + 0.6 * std::cos(angle), 1e-9);
      EXPECT_NEAR(row.front().z, -0.6 * std::sin(angle), 1e-9);
    }
    const bool is_outside = span < 0.1 - 0.1 * 2.0 / 12.0 - 1e-9 || span > 0.3 + 0.1 * 2.0 / 12.0 + 1e-9;
    if (is_outside) ++n_clean;
    for (std::size_t k = 0; k < row.size(); ++k)
      if (is_outside || clean[k].x < 0.5 * 1.4) {
        EXPECT_NEAR(row[k].x, clean[k].x, 1e-14);  // rows between sections are interpolated: rounding
        EXPECT_NEAR(row[k].z, clean[k].z, 1e-14);
      }
  }
  EXPECT_EQ(n_full, 2);
  EXPECT_GE(n_clean, 3);  // right tip, center, left tip
}

TEST(Deflection, wings_stay_closed_and_keep_their_volume_nearly) {
  const Wing wing = straight_wing();
  const double volume = solid_measures(make_wing(wing), SolidId(0)).volume;
  for (const ControlKind kind : {ControlKind::trailing_edge, ControlKind::leading_edge, ControlKind::all_moving})
    for (const double angle : {-25.0, 10.0, 35.0}) {
      const Model model = make_wing(deflected(wing, {{flap(-0.02, 0.3, kind == ControlKind::leading_edge ? 0.2 : 0.7, kind), angle * k_degree, 0.3}}));
      EXPECT_TRUE(free_edges(model).empty());
      const SolidMeasures m = solid_measures(model, SolidId(0));
      EXPECT_LT(m.open, 1e-6);
      EXPECT_NEAR(m.volume, volume, 0.03 * volume);
      for (const ModelFace& face : model.faces) EXPECT_EQ(face.name, "wing");
    }
}

TEST(Deflection, ailerons_of_the_widebody_move_apart) {
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
}

TEST(Deflection, what_cannot_be_is_refused_by_name) {
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
  EXPECT_THAT(error_of(wing, {{flap(0.1, 0.3, 0.7), 1.5}}), HasSubstr("at most 60"));
  EXPECT_THAT(error_of(wing, {{flap(0.3, 0.1, 0.7), 0.1}}), HasSubstr("do not ascend"));
  EXPECT_THAT(error_of(wing, {{flap(0.1, 0.3, 0.7), 0.1}, {flap(0.3, 0.4, 0.7), 0.2}}), HasSubstr("overlaps 'Flap'"));
  ControlSurface other = flap(0.1, 0.3, 0.7);
  other.wing = "tail";
  EXPECT_THAT(error_of(wing, {{other, 0.1}}), HasSubstr("belongs to wing 'tail'"));
  Wing cubic = wing;
  cubic.is_cubic = true;
  EXPECT_THAT(error_of(cubic, {{flap(0.1, 0.3, 0.7), 0.1}}), HasSubstr("cubic along its span"));
}

}  // namespace
}  // namespace sterna
