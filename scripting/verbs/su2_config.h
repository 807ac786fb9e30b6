// A configuration of SU2 for a mesh: its markers by the kinds of patches, flow, reference values and settings to start from.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/flow/flow_state.h"

namespace sterna::scripting {

struct Su2Options {
  std::string mesh;
  std::string solver = "automatic";
  std::string turbulence = "SA";
  double alpha = 0.0;
  double beta = 0.0;
  double reference_area = k_automatic;
  double reference_length = k_automatic;
  std::string wing;
  std::string half = "automatic";
  double wall_temperature = k_automatic;
  std::string monitor;
  int iterations = 5000;
  double cfl = 10.0;
};

/// What happens at an opening or an actuator disc.
struct Su2Boundary {
  double pressure = k_automatic;
  double total_pressure = k_automatic;
  double total_temperature = k_automatic;
  double thrust = k_automatic;
  double pressure_jump = k_automatic;
  double temperature_jump = 0.0;
};

/// Reference values of the whole aircraft.
struct Su2Reference {
  double area = k_automatic;    ///< m^2
  double length = k_automatic;  ///< m; automatic: that of the flow
  Point moment_origin{};        ///< m
  std::string source;           ///< "wing "main"": for the file and the log
};

/// The text of the configuration. Walls: MARKER_HEATFLUX (adiabatic) or MARKER_ISOTHERMAL, without viscosity MARKER_EULER; slip: MARKER_EULER; symmetry:
/// MARKER_SYM; farfield: MARKER_FAR; inflow and outflow of tunnels (no farfield): total conditions and pressure of the flow, along the patch's normal; of
/// bodies in a farfield, and actuator discs: as `boundaries` says. Forces are counted on all walls but those of tunnels (which touch an inflow or outflow).
/// Half models: half the area. What was decided goes to the log. \p boundaries by the names of patches
/// \throws Error(bad_argument) with everything that cannot be known from the mesh and what was given
std::string su2_config(const HybridMesh& mesh, const Su2Options& options, const volmesh::FlowState& flow, const Su2Reference& reference,
                       const std::map<std::string, Su2Boundary>& boundaries, const RunContext& context);

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::Su2Options> {
  using O = scripting::Su2Options;
  static constexpr std::string_view stage = "su2_config";
  static constexpr std::array fields = {
      Field<O>{
          .name = "mesh", .member = &O::mesh, .help = "name of the mesh file as SU2 is to read it (.su2 or .cgns); empty: that of the configuration with .su2"},
      Field<O>{.name = "solver",
               .member = &O::solver,
               .help = "automatic: RANS where the mesh has layers, else EULER",
               .choices = "automatic EULER NAVIER_STOKES RANS"},
      Field<O>{.name = "turbulence", .member = &O::turbulence, .help = "turbulence model of RANS", .choices = "SA SST"},
      Field<O>{.name = "alpha", .member = &O::alpha, .unit = Unit::radian, .min = -1.6, .max = 1.6, .help = "angle of attack: the flow comes from below"},
      Field<O>{.name = "beta",
               .member = &O::beta,
               .unit = Unit::radian,
               .min = -1.6,
               .max = 1.6,
               .help = "SU2's SIDESLIP_ANGLE: above zero the flow goes towards y > 0"},
      Field<O>{.name = "reference_area",
               .member = &O::reference_area,
               .min = 1e-12,
               .max = 1e9,
               .help = "m^2, of the whole aircraft, also for half models",
               .automatic = "of the wing of `reference`"},
      Field<O>{.name = "reference_length",
               .member = &O::reference_length,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "of pitching moments",
               .automatic = "mean aerodynamic chord of `reference`, or the flow's length"},
      Field<O>{.name = "wing", .member = &O::wing, .help = "name of the wing of `reference`; empty: the largest"},
      Field<O>{.name = "half",
               .member = &O::half,
               .help = "half model: SU2's area is half of the reference area; automatic: where one patch is a symmetry plane",
               .choices = "automatic yes no"},
      Field<O>{.name = "wall_temperature", .member = &O::wall_temperature, .min = 50.0, .max = 5000.0, .help = "K", .automatic = "adiabatic walls"},
      Field<O>{.name = "monitor",
               .member = &O::monitor,
               .help = "patterns of the names of patches whose forces count, separated by blanks; empty: all walls but those of tunnels"},
      Field<O>{.name = "iterations", .member = &O::iterations, .min = 1, .max = 100000000, .help = "at most"},
      Field<O>{.name = "cfl", .member = &O::cfl, .min = 0.01, .max = 1e6, .help = "CFL number at the start; SU2 adapts it"},
  };
};

template <>
struct Schema<scripting::Su2Boundary> {
  using O = scripting::Su2Boundary;
  static constexpr std::string_view stage = "boundaries";
  static constexpr std::array fields = {
      Field<O>{
          .name = "pressure", .member = &O::pressure, .min = 1e-6, .max = 1e10, .help = "Pa, static, of an outflow", .automatic = "of the flow, in tunnels"},
      Field<O>{
          .name = "total_pressure", .member = &O::total_pressure, .min = 1e-6, .max = 1e10, .help = "Pa, of an inflow", .automatic = "of the flow, in tunnels"},
      Field<O>{.name = "total_temperature",
               .member = &O::total_temperature,
               .min = 1.0,
               .max = 1e4,
               .help = "K, of an inflow",
               .automatic = "of the flow, in tunnels"},
      Field<O>{.name = "thrust",
               .member = &O::thrust,
               .min = -1e9,
               .max = 1e9,
               .help = "N, of an actuator disc: its pressure jump is this over its area",
               .automatic = "not given"},
      Field<O>{
          .name = "pressure_jump", .member = &O::pressure_jump, .min = -1e9, .max = 1e9, .help = "Pa, over an actuator disc", .automatic = "thrust over area"},
      Field<O>{.name = "temperature_jump", .member = &O::temperature_jump, .min = -1e4, .max = 1e4, .help = "K, total, over an actuator disc"},
  };
};

}  // namespace sterna
