// Air at an altitude. The U.S. Standard Atmosphere 1976 is used, which is the ICAO standard atmosphere (Doc 7488) up to 32 km and equal to ISO 2533 below 80
// km.
#pragma once

namespace sterna::volmesh {

inline constexpr double k_gas_constant = 287.05287;   ///< J/(kg K) of air: 8314.32 / 28.9644, both as the standard defines them
inline constexpr double k_heat_ratio = 1.4;           ///< ratio of specific heats of air
inline constexpr double k_lowest_altitude = -5000.0;  ///< m, geopotential altitude: start of the ICAO and 1976 tables
/// m, geopotential altitude (86 km geometric): above it, the composition of the air changes and the formulas are not valid.
inline constexpr double k_highest_altitude = 84852.0;

struct AirState {
  double temperature = 0.0;  ///< K
  double pressure = 0.0;     ///< Pa
  double density = 0.0;      ///< kg/m^3
};

/// Returns the air at a geopotential (pressure) altitude in m, as used for flight levels and ISA tables. With an offset ("ISA+15") the pressure is that of the
/// altitude, and the temperature is higher by the offset in K.
/// \throws Error(bad_argument) for altitudes outside of [k_lowest_altitude, k_highest_altitude], and for an offset that makes the temperature zero or negative
AirState standard_atmosphere(double altitude, double temperature_offset = 0.0);

/// Returns the dynamic viscosity of air in Pa s, by Sutherland's formula with the constants of the 1976 standard: 1.458e-6 T^1.5 / (T + 110.4).
double viscosity_of_air(double temperature);
/// Returns the speed of sound in m/s.
double speed_of_sound(double temperature);

}  // namespace sterna::volmesh
