// Based on: U.S. Standard Atmosphere, 1976 (NASA TM-X-74335), part 1: table 4 (layers), eqs. (33a), (33b) for the pressure, (51) for the viscosity.
#include "volmesh/flow/standard_atmosphere.h"

#include <array>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/print_text.h"

namespace sterna::volmesh {
namespace {

constexpr double k_gravity = 9.80665;               ///< m/s^2
constexpr double k_sea_level_pressure = 101325.0;   ///< Pa
constexpr double k_sea_level_temperature = 288.15;  ///< K
constexpr double k_least_temperature = 50.0;        ///< K: lowest temperature; it is far below any air temperature, where Sutherland's formula is not valid

struct Layer {
  double base;   ///< m, geopotential
  double lapse;  ///< K/m
};
constexpr std::array<Layer, 7> k_layers = {
    {{0.0, -6.5e-3}, {11000.0, 0.0}, {20000.0, 1e-3}, {32000.0, 2.8e-3}, {47000.0, 0.0}, {51000.0, -2.8e-3}, {71000.0, -2e-3}}};

/// Returns the pressure at the height dh above a point with pressure p and temperature t.
double pressure_above(double p, double t, double lapse, double dh) {
  const double c = k_gravity / k_gas_constant;
  return lapse == 0.0 ? p * std::exp(-c * dh / t) : p * std::pow(t / (t + lapse * dh), c / lapse);
}

}  // namespace

AirState standard_atmosphere(double altitude, double temperature_offset) {
  if (!(altitude >= k_lowest_altitude && altitude <= k_highest_altitude))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "computing the state of the air",
                 .problem = print_text("altitude %g m is outside of the standard atmosphere, %g .. %.6g m", altitude, k_lowest_altitude, k_highest_altitude),
                 .hint = "give pressure and temperature, or density and viscosity, instead"});
  AirState air{.temperature = k_sea_level_temperature, .pressure = k_sea_level_pressure};
  for (std::size_t i = 0; i < k_layers.size(); ++i) {
    const bool is_last = i + 1 == k_layers.size() || altitude <= k_layers[i + 1].base;  // the lowest layer extends below sea level
    const double dh = (is_last ? altitude : k_layers[i + 1].base) - k_layers[i].base;
    air.pressure = pressure_above(air.pressure, air.temperature, k_layers[i].lapse, dh);
    air.temperature += k_layers[i].lapse * dh;
    if (is_last) break;
  }
  air.temperature += temperature_offset;
  if (!(air.temperature >= k_least_temperature))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "computing the state of the air",
                 .problem = print_text("with a temperature_offset of %g K the air at %g m has %g K, expected at least %g", temperature_offset, altitude,
                                       air.temperature, k_least_temperature)});
  air.density = air.pressure / (k_gas_constant * air.temperature);
  return air;
}

double viscosity_of_air(double temperature) { return 1.458e-6 * temperature * std::sqrt(temperature) / (temperature + 110.4); }
double speed_of_sound(double temperature) { return std::sqrt(k_heat_ratio * k_gas_constant * temperature); }

}  // namespace sterna::volmesh
