// Options of deflections, for wings described by scripts and for control surfaces described by files.
#pragma once

#include <string>
#include <vector>

#include "geom/base/schema.h"
#include "geom/model/set_controls.h"
#include "scripting/lua/table_reader.h"

namespace sterna::scripting {

struct ControlOptions {
  std::string kind = "trailing_edge";
  std::string other_side = "same";
};
struct DeflectOptions {
  double angle = k_automatic;
  std::string gap = "sealed";
  double fairing = k_automatic;
};

OtherSide other_side_of(const std::string& choice);

/// Reads { Elevator = 5*deg, ["Flap*"] = { angle = 20*deg, gap = "open" } }. Returns the settings in the order of the names; notes problems.
std::vector<ControlSetting> read_control_settings(const ScriptTable& table, const std::string& where, TableReader& reader);
/// Returns the help on the content of an entry's table.
std::string control_settings_help();

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::ControlOptions> {
  using O = scripting::ControlOptions;
  static constexpr std::string_view stage = "control";
  static constexpr std::array fields = {
      Field<O>{.name = "kind",
               .member = &O::kind,
               .help = "part that moves: the chord behind the hinge, the chord in front of the hinge, or the whole chord",
               .choices = "trailing_edge leading_edge all_moving"},
      Field<O>{.name = "other_side",
               .member = &O::other_side,
               .help = "deflection on the other half of the wing: same for flaps, opposite for ailerons",
               .choices = "same opposite none"},
  };
};
template <>
struct Schema<scripting::DeflectOptions> {
  using O = scripting::DeflectOptions;
  static constexpr std::string_view stage = "deflect";
  static constexpr std::array fields = {
      Field<O>{.name = "angle",
               .member = &O::angle,
               .unit = Unit::radian,
               .min = -1.0471975511965976,
               .max = 1.0471975511965976,
               .help = "deflection, positive with the trailing edge down; leading edge flaps: leading edge down; all-moving surfaces: nose up",
               .required = true},
      Field<O>{.name = "gap", .member = &O::gap, .help = "sealed: the skin bends; open: a separate part behind a slot", .choices = "sealed open"},
      Field<O>{.name = "fairing",
               .member = &O::fairing,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "for gap = \"sealed\": spanwise length beside the ends over which the deflection fades to zero",
               .automatic = "a tenth of the mean chord at the ends of the control surface"},
  };
};

}  // namespace sterna
