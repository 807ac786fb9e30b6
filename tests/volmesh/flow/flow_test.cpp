// Tables of the standard atmosphere, the spacings of DPW-4, and refused input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geom/base/error.h"
#include "tests/support/error_of.h"
#include "volmesh/flow/boundary_layer.h"
#include "volmesh/flow/flow_state.h"
#include "volmesh/flow/standard_atmosphere.h"

namespace sterna::volmesh {
namespace {

TEST(StandardAtmosphere, MatchesItsTables) {
  struct Row {
    double altitude, temperature, pressure, density;
  };
  // U.S. Standard Atmosphere 1976 / ICAO Doc 7488, by geopotential altitude; six digits, as printed.
  for (const Row& row : {Row{0, 288.15, 101325, 1.225}, Row{-2000, 301.15, 127774, 1.47808}, Row{5000, 255.65, 54019.9, 0.736116},
                         Row{11000, 216.65, 22632.1, 0.363918}, Row{20000, 216.65, 5474.89, 0.0880349}, Row{32000, 228.65, 868.019, 0.0132250},
                         Row{47000, 270.65, 110.906, 0.00142753}, Row{51000, 270.65, 66.9389, 0.000861606}, Row{71000, 214.65, 3.95642, 0.0000642110}}) {
    const AirState air = standard_atmosphere(row.altitude);
    EXPECT_NEAR(air.temperature, row.temperature, 1e-9) << row.altitude;
    EXPECT_NEAR(air.pressure / row.pressure, 1.0, 2e-5) << row.altitude;
    EXPECT_NEAR(air.density / row.density, 1.0, 2e-5) << row.altitude;
  }
  EXPECT_NEAR(standard_atmosphere(84852.0).temperature, 186.946, 1e-3);
  EXPECT_NEAR(viscosity_of_air(288.15), 1.7894e-5, 1e-9);
  EXPECT_NEAR(speed_of_sound(288.15), 340.294, 1e-3);
}

TEST(StandardAtmosphere, AnOffsetWarmsAtTheSamePressure) {
  const AirState standard = standard_atmosphere(3000.0), warm = standard_atmosphere(3000.0, 20.0);
  EXPECT_EQ(warm.pressure, standard.pressure);
  EXPECT_DOUBLE_EQ(warm.temperature, standard.temperature + 20.0);
  EXPECT_NEAR(warm.density * warm.temperature, standard.density * standard.temperature, 1e-9);
}

TEST(StandardAtmosphere, EndsWhereItsFormulasEnd) {
  for (const double altitude : {-5000.1, 84852.1, 1e9, std::nan("")})
    test::expect_error(ErrorCode::bad_argument, "is outside of the standard atmosphere, -5000 .. 84852 m", [&] { (void)standard_atmosphere(altitude); });
  test::expect_error(ErrorCode::bad_argument, "with a temperature_offset of -200 K the air at 11000 m has 16.65 K, expected at least",
                     [&] { (void)standard_atmosphere(11000.0, -200.0); });
}

FlowState at_reynolds(double reynolds, double length) { return flow_state({.length = length, .reynolds = reynolds}); }

// aiaa-dpw.org/Workshop4/gridding_guidelines_4.html, as docs/method/quality.md, "Workshop guidelines", gives it: CRM, c_ref = 275.80 in.
TEST(FirstHeight, MatchesDpw4SpacingsWithin2Percent) {
  constexpr double k_inch = 0.0254, k_chord = 275.80 * k_inch;
  struct Level {
    double reynolds, y_plus, spacing_in;
  };
  for (const char* law : {"schlichting", "seventh_root"})
    for (const Level& level : {Level{5e6, 1.0, 0.001478}, Level{5e6, 2.0 / 3.0, 0.000985}, Level{5e6, 4.0 / 9.0, 0.000657}, Level{5e6, 8.0 / 27.0, 0.000438},
                               Level{20e6, 2.0 / 3.0, 0.000273}}) {
      const FirstHeight first = first_height({.y_plus = level.y_plus, .law = law}, at_reynolds(level.reynolds, k_chord));
      EXPECT_NEAR(first.height / (level.spacing_in * k_inch), 1.0, 0.02) << law << " Re " << level.reynolds << " y+ " << level.y_plus;
    }
}

TEST(FirstHeight, LawsAgreeWhereTheyOverlap) {
  // Local laws agree within a tenth at Re 5e6, as in published comparisons. The mean over a plate is 1/0.8 .. 1/0.85 of the local value at its end (exactly
  // 1/0.8 for Re^-0.2).
  const double local = skin_friction("schlichting", 5e6);
  for (const char* law : {"seventh_root", "kays_crawford", "prandtl"}) EXPECT_NEAR(skin_friction(law, 5e6) / local, 1.0, 0.1) << law;
  for (const char* law : {"prandtl_schlichting", "ittc57"}) EXPECT_NEAR(skin_friction(law, 5e6) / local, 1.2, 0.06) << law;
  EXPECT_NEAR(skin_friction("ittc57", 1e7), 0.003, 1e-6);                 // 0.075 / 25
  EXPECT_NEAR(skin_friction("prandtl_schlichting", 1e7), 0.00300, 1e-5);  // table 21.1 of Schlichting
  EXPECT_NEAR(skin_friction("prandtl", 1e5), 0.00592, 1e-8);
  test::expect_error(ErrorCode::bad_argument, "unknown friction law \"blasius\"\n  try: use one of schlichting, ",
                     [&] { (void)skin_friction("blasius", 1e6); });
  test::expect_error(ErrorCode::bad_argument, "Reynolds number 9000 is outside 10000 .. ", [&] { (void)skin_friction("prandtl", 9e3); });
  test::expect_error(ErrorCode::bad_argument, "Reynolds number 1e+12 is outside 10000 .. ", [&] { (void)skin_friction("prandtl", 1e12); });
}

TEST(FirstHeight, IsLinearAndDoubledForCellCentres) {
  const FlowState flow = flow_state({.length = 4.2, .mach = 0.78, .altitude = 11000.0});
  const FirstHeight one = first_height({.y_plus = 1.0}, flow);
  EXPECT_DOUBLE_EQ(first_height({.y_plus = 30.0}, flow).height, 30.0 * one.height);
  EXPECT_DOUBLE_EQ(first_height({.y_plus = 1.0, .at = "cell_centre"}, flow).height, 2.0 * one.height);
  // y+ = y u_tau / nu, recomputed from the flow conditions
  EXPECT_NEAR(one.wall_distance * one.friction_velocity * flow.density / flow.viscosity, 1.0, 1e-12);
  EXPECT_THAT(describe(one), testing::AllOf(testing::HasSubstr("y+ 1 at the first node"), testing::HasSubstr("Mach 0.78"),
                                            testing::HasSubstr("11000 m of the standard atmosphere")));
}

TEST(FlowState, EquivalentInputsGiveTheSameFlow) {
  const FlowState flight = flow_state({.length = 4.2, .mach = 0.78, .altitude = 11000.0});
  EXPECT_NEAR(flight.speed, 0.78 * 295.0696, 1e-3);
  EXPECT_NEAR(flight.reynolds, flight.speed * flight.density * 4.2 / flight.viscosity, 1e-3);
  const FlowConditions others[] = {{.length = 4.2, .speed = flight.speed, .temperature = flight.temperature, .pressure = flight.pressure},
                                   {.length = 4.2, .mach = 0.78, .temperature = flight.temperature, .density = flight.density},
                                   {.length = 4.2, .speed = flight.speed, .density = flight.density, .viscosity = flight.viscosity},
                                   {.length = 4.2, .mach = 0.78, .pressure = flight.pressure, .density = flight.density},
                                   {.length = 4.2, .reynolds = flight.reynolds, .mach = 0.78, .temperature = flight.temperature}};
  for (const FlowConditions& other : others) {
    const FlowState flow = flow_state(other);
    EXPECT_NEAR(flow.reynolds / flight.reynolds, 1.0, 1e-12);
    EXPECT_NEAR(flow.speed / flight.speed, 1.0, 1e-12);
    EXPECT_NEAR(flow.density / flight.density, 1.0, 1e-12);
  }
  const FlowState alone = flow_state({.length = 2.0, .reynolds = 3e6});
  EXPECT_TRUE(is_automatic(alone.speed));
  EXPECT_EQ(describe(alone), "Re 3e+06 at 2 m");
}

TEST(FlowState, RefusesMissingOrDuplicateInputs) {
  const auto message = [](const FlowConditions& given) {
    try {
      flow_state(given);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(message({.mach = 0.5, .altitude = 0.0}), testing::HasSubstr("length is missing"));
  EXPECT_THAT(message({.length = 1.0, .mach = 0.5}),
              testing::AllOf(testing::HasSubstr("temperature (to compute the speed from the Mach number)"), testing::HasSubstr("density")));
  EXPECT_THAT(message({.length = 1.0, .mach = 0.5, .speed = 100.0, .altitude = 0.0}), testing::HasSubstr("mach and speed"));
  EXPECT_THAT(message({.length = 1.0, .mach = 0.5, .altitude = 0.0, .pressure = 1e5}), testing::HasSubstr("altitude and pressure"));
  EXPECT_THAT(message({.length = 1.0, .reynolds = 1e6, .mach = 0.5, .altitude = 0.0}), testing::HasSubstr("leave one of them out"));
  EXPECT_THAT(message({.length = 1.0, .mach = 0.5, .temperature_offset = 10.0, .temperature = 300.0, .pressure = 1e5}),
              testing::HasSubstr("temperature_offset needs an altitude"));
}

TEST(BoundaryLayer, ThicknessMatchesFormula) {
  const FlowState flow = at_reynolds(1e7, 2.0);
  EXPECT_NEAR(layer_thickness({}, flow), 0.37 * 2.0 / std::pow(1e7, 0.2), 1e-12);
  EXPECT_NEAR(layer_thickness({.factor = 1.3}, flow), 1.3 * layer_thickness({}, flow), 1e-12);
  EXPECT_NEAR(layer_thickness({.thickness_law = "seventh_root"}, flow), 0.16 * 2.0 / std::pow(1e7, 1.0 / 7.0), 1e-12);
}

}  // namespace
}  // namespace sterna::volmesh
