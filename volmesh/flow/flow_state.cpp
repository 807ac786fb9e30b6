#include "volmesh/flow/flow_state.h"

#include "geom/base/error.h"
#include "geom/base/print_text.h"
#include "volmesh/flow/standard_atmosphere.h"

namespace sterna::volmesh {
namespace {

bool has(double value) { return !is_automatic(value); }

/// Collects all input errors, so that they are reported together.
class Problems {
 public:
  void add(const std::string& text) { text_ += (text_.empty() ? "" : "; ") + text; }
  void finish() const {
    if (text_.empty()) return;
    throw Error(
        {.code = ErrorCode::bad_argument,
         .attempted = "finding the flow conditions",
         .problem = text_,
         .hint = "give length and one of: mach (or speed) and altitude; mach (or speed), temperature and pressure; speed, density and viscosity; reynolds"});
  }

 private:
  std::string text_;
};

void refuse_contradictions(const FlowConditions& given, Problems& problems) {
  if (!has(given.length)) problems.add("length is missing");
  if (has(given.mach) && has(given.speed)) problems.add("mach and speed cannot both be given");
  if (has(given.altitude)) {
    if (has(given.temperature)) problems.add("altitude and temperature cannot both be given (temperature_offset makes the air at an altitude warmer)");
    if (has(given.pressure)) problems.add("altitude and pressure cannot both be given");
    if (has(given.density)) problems.add("altitude and density cannot both be given");
  } else if (given.temperature_offset != 0.0) {
    problems.add("temperature_offset needs an altitude");
  }
  if (has(given.temperature) && has(given.pressure) && has(given.density))
    problems.add("temperature, pressure and density cannot all be given: two of them are enough");
}

/// Determines temperature, pressure, density and viscosity, if they are given or follow from other values.
void find_gas(const FlowConditions& given, FlowState& flow) {
  flow.temperature = given.temperature;
  flow.pressure = given.pressure;
  flow.density = given.density;
  flow.viscosity = given.viscosity;
  if (has(given.altitude)) {
    const AirState air = standard_atmosphere(given.altitude, given.temperature_offset);
    flow.altitude = given.altitude;
    flow.temperature = air.temperature;
    flow.pressure = air.pressure;
    flow.density = air.density;
  } else if (has(flow.temperature) && has(flow.pressure)) {
    flow.density = flow.pressure / (k_gas_constant * flow.temperature);
  } else if (has(flow.temperature) && has(flow.density)) {
    flow.pressure = flow.density * k_gas_constant * flow.temperature;
  } else if (has(flow.pressure) && has(flow.density)) {
    flow.temperature = flow.pressure / (flow.density * k_gas_constant);
  }
  if (!has(flow.viscosity) && has(flow.temperature)) flow.viscosity = viscosity_of_air(flow.temperature);
}

void find_speed(const FlowConditions& given, FlowState& flow) {
  flow.mach = given.mach;
  flow.speed = given.speed;
  if (!has(flow.temperature)) return;
  const double sound = speed_of_sound(flow.temperature);
  if (has(flow.mach)) flow.speed = flow.mach * sound;
  else if (has(flow.speed)) flow.mach = flow.speed / sound;
}

/// Computes the Reynolds number from the gas, or a missing gas property from the Reynolds number.
void find_reynolds(const FlowConditions& given, FlowState& flow, Problems& problems) {
  const bool is_known = has(flow.speed) && has(flow.density) && has(flow.viscosity);
  if (!has(given.reynolds)) {
    if (is_known) {
      flow.reynolds = flow.speed * flow.density * flow.length / flow.viscosity;
      return;
    }
    std::string missing;
    const auto need = [&](bool is_there, const char* what) { missing += is_there ? "" : (missing.empty() ? "" : ", ") + std::string(what); };
    need(has(flow.speed), has(flow.mach) ? "temperature (to compute the speed from the Mach number)" : "mach or speed");
    need(has(flow.density), "density (altitude, or temperature and pressure)");
    need(has(flow.viscosity), "viscosity (or the temperature, for air)");
    problems.add("the Reynolds number cannot be computed without " + missing);
    return;
  }
  if (is_known) {
    problems.add("reynolds is given, but also follows from speed, density and viscosity: leave one of them out");
    return;
  }
  flow.reynolds = given.reynolds;
  if (has(flow.speed) && has(flow.viscosity) && !has(flow.density)) {
    flow.density = flow.reynolds * flow.viscosity / (flow.speed * flow.length);
    if (has(flow.temperature)) flow.pressure = flow.density * k_gas_constant * flow.temperature;
  } else if (has(flow.speed) && has(flow.density)) {
    flow.viscosity = flow.speed * flow.density * flow.length / flow.reynolds;
  } else if (has(flow.density) && has(flow.viscosity)) {
    flow.speed = flow.reynolds * flow.viscosity / (flow.density * flow.length);
    if (has(flow.temperature)) flow.mach = flow.speed / speed_of_sound(flow.temperature);
  }
}

}  // namespace

FlowState flow_state(const FlowConditions& given) {
  Problems problems;
  refuse_contradictions(given, problems);
  problems.finish();
  FlowState flow{.length = given.length};
  find_gas(given, flow);
  find_speed(given, flow);
  find_reynolds(given, flow, problems);
  problems.finish();
  return flow;
}

std::string describe(const FlowState& flow) {
  std::string text = print_text("Re %.4g at %.6g m", flow.reynolds, flow.length);
  const auto add = [&](double value, const std::string& what) { text += has(value) ? ", " + what : ""; };
  add(flow.mach, print_text("Mach %.4g", flow.mach));
  add(flow.speed, print_text("%.5g m/s", flow.speed));
  add(flow.temperature, print_text("%.5g K", flow.temperature));
  add(flow.pressure, print_text("%.6g Pa", flow.pressure));
  add(flow.density, print_text("%.5g kg/m^3", flow.density));
  add(flow.viscosity, print_text("%.4g Pa s", flow.viscosity));
  add(flow.altitude, print_text("%g m of the standard atmosphere", flow.altitude));
  return text;
}

}  // namespace sterna::volmesh
