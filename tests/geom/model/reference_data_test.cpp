// Reference data: formulas for trapezoids, and published values of the ONERA M6 and the D150.
#include "geom/model/reference_data.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geom/model/components.h"
#include "geom/model/cpacs.h"
#include "geom/model/model_measures.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

WingSection diamond(Point leading, double chord) {
  return {.name = "s",
          .leading_edge = leading,
          .chord = chord,
          .points = {{1.0, 0.0}, {0.6, 0.05}, {0.2, 0.05}, {0.0, 0.0}, {0.2, -0.05}, {0.6, -0.05}, {1.0, 0.0}}};
}

TEST(ReferenceData, TrapezoidMatchesFormulas) {
  const double root = 2.0, tip = 1.0, half_span = 5.0;
  const Wing wing{.name = "W", .is_symmetric = true, .sections = {diamond({1.5, half_span, 0.0}, tip), diamond({0.0, 0.0, 0.0}, root)}};
  const WingReference r = wing_reference(wing);
  EXPECT_NEAR(r.span, 10.0, 1e-12);
  EXPECT_NEAR(r.area, 15.0, 1e-12);
  EXPECT_NEAR(r.mean_geometric_chord, 1.5, 1e-12);
  const double taper = tip / root;
  EXPECT_NEAR(r.mean_aerodynamic_chord, 2.0 / 3.0 * root * (1 + taper + taper * taper) / (1 + taper), 1e-12);
  EXPECT_NEAR(r.aerodynamic_chord_start.x, 1.5 / half_span * half_span / 3.0 * (1 + 2 * taper) / (1 + taper), 1e-12);
  EXPECT_NEAR(r.aerodynamic_chord_start.y, 0.0, 1e-12);
  EXPECT_NEAR(r.aspect_ratio, 100.0 / 15.0, 1e-12);
}

// Dihedral shortens span and area alike: the chords stay those of the flat wing. Vertical winglets contribute to neither.
TEST(ReferenceData, DihedralLeavesTheMeanChordsAlone) {
  const double root = 0.17, tip = 0.09, half_span = 0.22;
  const auto wing = [&](double dihedral, double winglet) {
    Wing w{.name = "V", .is_symmetric = true};
    const Point end{0.1, half_span, half_span * std::tan(dihedral)};
    if (winglet > 0.0) w.sections.push_back(diamond(end + Vec3{0.0, 0.0, winglet}, tip));
    w.sections.push_back(diamond(end, tip));
    w.sections.push_back(diamond({}, root));
    return wing_reference(w);
  };
  const double taper = tip / root, aerodynamic = 2.0 / 3.0 * root * (1 + taper + taper * taper) / (1 + taper);
  for (const double dihedral : {0.0, 0.3, 38.0 / 180.0 * M_PI}) {
    const WingReference r = wing(dihedral, 0.0);
    EXPECT_NEAR(r.mean_geometric_chord, 0.13, 1e-12);
    EXPECT_NEAR(r.mean_aerodynamic_chord, aerodynamic, 1e-12);
    EXPECT_NEAR(r.area, 0.13 * 2 * half_span, 1e-12);
    EXPECT_NEAR(r.unrolled_area, r.area / std::cos(dihedral), 1e-12);
    EXPECT_NEAR(r.aspect_ratio, r.span / 0.13, 1e-12);
  }
  const WingReference r = wing(0.0, 0.05);
  EXPECT_NEAR(r.area, 0.13 * 2 * half_span, 1e-12);
  EXPECT_NEAR(r.mean_geometric_chord, 0.13, 1e-12);
  EXPECT_NEAR(r.unrolled_area, r.area + 2 * 0.05 * tip, 1e-12);
  Wing fin{.name = "F", .sections = {diamond({0.5, 0.0, 2.0}, 1.0), diamond({0.0, 0.0, 0.0}, 2.0)}};
  EXPECT_NEAR(wing_reference(fin).area, 3.0, 1e-12);
  EXPECT_NEAR(wing_reference(fin).projected_area, 0.0, 1e-12);
}

// Schmitt and Charpin, AGARD AR-138 (1979), quoted from memory (no copy is stored here): semi span 1.1963 m, root 0.8059 m, taper 0.562, mean aerodynamic chord
// 0.64607 m, half area 0.7532 m2. The file has 1.1963 along the swept leading edge instead of along the span. Its span is therefore this length times
// cos 30 degrees: 0.866 of the published span.
TEST(ReferenceData, OneraM6) {
  STERNA_NEEDS_SHARED_DATA();
  Wing wing = read_cpacs(test::shared_data() / "cpacs/onera_m6.xml", RunContext()).aircraft.wings.at(0);
  const WingReference file = wing_reference(wing);
  EXPECT_NEAR(file.span, 2 * 1.1963 * std::cos(M_PI / 6), 1e-9);
  EXPECT_NEAR(file.mean_aerodynamic_chord, 0.64607, 0.005 * 0.64607);
  for (WingSection& section : wing.sections)
    for (Point& p : section.loop) p.y /= std::cos(M_PI / 6);
  const WingReference stretched = wing_reference(wing);
  EXPECT_NEAR(stretched.span, 2 * 1.1963, 0.005 * 2 * 1.1963);
  EXPECT_NEAR(stretched.area, 2 * 0.7532, 0.005 * 2 * 0.7532);
}

// The file itself states area 122.4 m2 and mean chord 4.193 m (<reference>). According to its header the shape comes from the A320-200, which spans 33.91 m
// without wing tip fences (this number is from memory; no source is stored here).
TEST(ReferenceData, d150) {
  STERNA_NEEDS_SHARED_DATA();
  const Aircraft aircraft = read_cpacs(test::shared_data() / "cpacs/d150.xml", RunContext()).aircraft;
  const WingReference r = wing_reference(aircraft.wings.at(0));
  EXPECT_NEAR(r.span, 33.91, 0.005 * 33.91);
  ASSERT_TRUE(aircraft.reference_area && aircraft.reference_length);
  EXPECT_NEAR(r.projected_area, *aircraft.reference_area, 0.005 * 122.4);
  EXPECT_NEAR(r.mean_aerodynamic_chord, *aircraft.reference_length, 0.005 * 4.193);
  const WingReference older =
      wing_reference(read_cpacs(test::shared_data() / "cpacs/CPACS_30_D150.xml", RunContext()).aircraft.wings.at(0));  // the same aircraft in another file
  EXPECT_NEAR(older.span, r.span, 1e-3);
  EXPECT_NEAR(older.projected_area, r.projected_area, 1e-3);
  const std::vector<BodyMeasures> parts = model_measures(make_components(aircraft, RunContext()), RunContext()).solids;
  ASSERT_EQ(parts.size(), 4u);
  for (const BodyMeasures& part : parts) {
    EXPECT_GT(part.volume, 0.0);
    EXPECT_GT(part.area, 0.0);
  }
  EXPECT_GT(parts[1].area, 2.0 * r.area);  // both sides, and both are curved
  EXPECT_LT(parts[1].area, 2.1 * r.area);
}

}  // namespace
}  // namespace sterna
