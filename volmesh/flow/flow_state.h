// Computes the flow conditions around the body: Reynolds number, speed and gas state from the values that the user gives.
#pragma once

#include <string>

#include "geom/base/number_with_unit.h"
#include "geom/base/schema.h"

namespace sterna::volmesh {

/// Values given by the user; k_automatic: not given.
struct FlowConditions {
  double length = k_automatic;
  double reynolds = k_automatic;
  double mach = k_automatic;
  double speed = k_automatic;
  double altitude = k_automatic;
  double temperature_offset = 0.0;
  double temperature = k_automatic;
  double pressure = k_automatic;
  double density = k_automatic;
  double viscosity = k_automatic;
};

/// Complete flow state. Values that are k_automatic cannot be derived from the given values, and are not needed for the Reynolds number.
struct FlowState {
  double length = k_automatic;    ///< m, reference length of the Reynolds number
  double reynolds = k_automatic;  ///< speed * density * length / viscosity
  double mach = k_automatic;
  double speed = k_automatic;        ///< m/s
  double temperature = k_automatic;  ///< K
  double pressure = k_automatic;     ///< Pa
  double density = k_automatic;      ///< kg/m^3
  double viscosity = k_automatic;    ///< Pa s, dynamic
  double altitude = k_automatic;     ///< m, if the standard atmosphere was used
};

/// Computes the flow state from one of these sets of values: altitude with mach or speed (air of the standard atmosphere); temperature and pressure or density,
/// with mach or speed (air); density, viscosity and speed (any fluid); reynolds alone, or with temperature and mach or speed, from which the density follows
/// (air). The length is always required. A viscosity given by the user replaces that of Sutherland's formula.
/// \throws Error(bad_argument) with all missing or redundant values; the errors of standard_atmosphere
FlowState flow_state(const FlowConditions& given);

/// Returns a line with the known values, such as "Re 2.14e+07 at 4.2 m, Mach 0.78, 230.2 m/s, 216.7 K, 22632 Pa, 0.3639 kg/m^3, 1.422e-05 Pa s, 11000 m of the
/// standard atmosphere".
std::string describe(const FlowState& flow);

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::FlowConditions> {
  using O = volmesh::FlowConditions;
  static constexpr std::string_view stage = "flow";
  static constexpr std::string_view not_given = "not given";
  static constexpr std::array fields = {
      Field<O>{.name = "length",
               .member = &O::length,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "reference length of the Reynolds number: mean chord, or distance along the flow to the location of interest",
               .automatic = "must be given"},
      Field<O>{.name = "reynolds",
               .member = &O::reynolds,
               .min = 1.0,
               .max = 1e12,
               .help = "Reynolds number based on length",
               .automatic = "from speed, density and viscosity"},
      Field<O>{.name = "mach", .member = &O::mach, .min = 1e-6, .max = 30.0, .help = "Mach number", .automatic = not_given},
      Field<O>{.name = "speed", .member = &O::speed, .min = 1e-9, .max = 1e5, .help = "flow speed in m/s, instead of the Mach number", .automatic = not_given},
      Field<O>{.name = "altitude",
               .member = &O::altitude,
               .unit = Unit::metre,
               .min = -5000.0,
               .max = 84852.0,
               .help = "geopotential (pressure) altitude in the U.S. standard atmosphere 1976 (ICAO)",
               .automatic = not_given},
      Field<O>{.name = "temperature_offset",
               .member = &O::temperature_offset,
               .unit = k_kelvin,
               .min = -150.0,
               .max = 150.0,
               .help = "temperature difference to the standard atmosphere at the altitude (ISA+15: 15)"},
      Field<O>{.name = "temperature",
               .member = &O::temperature,
               .unit = k_kelvin,
               .min = 50.0,
               .max = 5000.0,
               .help = "static temperature of the air",
               .automatic = not_given},
      Field<O>{.name = "pressure", .member = &O::pressure, .min = 1e-6, .max = 1e10, .help = "static pressure of the air, Pa", .automatic = not_given},
      Field<O>{.name = "density", .member = &O::density, .min = 1e-12, .max = 1e5, .help = "density, kg/m^3", .automatic = "from temperature and pressure"},
      Field<O>{.name = "viscosity",
               .member = &O::viscosity,
               .min = 1e-9,
               .max = 1e3,
               .help = "dynamic viscosity, Pa s",
               .automatic = "Sutherland's formula for air"},
  };
};

}  // namespace sterna
