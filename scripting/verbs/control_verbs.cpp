// wing:deflect{} and wing:control{}.
#include <algorithm>
#include <array>

#include "geom/model/deflection.h"
#include "scripting/lua/component_value.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/verbs/component_verbs.h"

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

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::ControlOptions> {
  using O = scripting::ControlOptions;
  static constexpr std::string_view stage = "control";
  static constexpr std::array fields = {
      Field<O>{.name = "kind",
               .member = &O::kind,
               .help = "what moves: behind the hinge, before it, all of the chord",
               .choices = "trailing_edge leading_edge all_moving"},
      Field<O>{.name = "other_side",
               .member = &O::other_side,
               .help = "what the image on the wing's other half does: flaps the same, ailerons the opposite",
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
               .help = "trailing edge down; leading edge flaps: leading edge down; all-moving: nose up",
               .required = true},
      Field<O>{.name = "gap", .member = &O::gap, .help = "sealed: the skin bends; open: a part of its own behind a slot", .choices = "sealed open"},
      Field<O>{.name = "fairing",
               .member = &O::fairing,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "sealed: along the span over which it returns to the wing beside its ends",
               .automatic = "a tenth of the mean chord at its ends"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

ScriptValue change_wing(const ScriptCall& call, bool is_deflected) {
  const std::string_view usage = is_deflected ? k_deflect_usage : k_control_usage;
  const ComponentHandle& component = self<ComponentHandle>(call);
  const auto* wing = std::get_if<Wing>(&component->shape);
  if (!wing) reject(call, "is for wings, not for " + std::string(component->type_text()));
  const ScriptTable table = table_argument(call, 1, usage);
  ControlOptions control;
  DeflectOptions deflect;
  const OptionTable control_schema = sterna::options_of(control), deflect_schema = sterna::options_of(deflect);
  TableReader reader(table, call.attempted());
  Deflection d{.surface = {.wing = wing->name}};
  const std::vector<ScriptValue>& items = reader.items();
  const auto* name = items.size() == 1 ? std::get_if<std::string>(&items.front()) : nullptr;
  if (!name || name->empty()) reader.add_problem("entry 1: expected one name: " + std::string(usage));
  else d.surface.name = *name;
  if (name && std::any_of(component->deflections.begin(), component->deflections.end(), [&](const Deflection& other) { return other.surface.name == *name; }))
    reader.add_problem("this wing has a control surface \"" + *name + "\" already");
  constexpr std::string_view k_pair = "{part of the span from the root, part of the chord}";
  const auto from = read_pair(reader, "from", k_pair), to = read_pair(reader, "to", k_pair);
  const ScriptValue* hinge = reader.field("hinge");
  const auto rows = hinge ? rows_of(*hinge, 2) : std::nullopt;
  if (hinge && !rows) reader.add_problem("hinge: expected a list of places {{span, chord}, ...}");
  const bool has_both = table.fields.contains("from") && table.fields.contains("to"), has_any = table.fields.contains("from") || table.fields.contains("to");
  if (hinge ? has_any : !has_both) reader.add_problem("needs from and to, or hinge = {{span, chord}, ...}: " + std::string(usage));
  reader.read_options(control_schema);
  if (is_deflected) {
    reader.read_options(deflect_schema);
    reader.require(deflect_schema);
  }
  reader.finish();
  if (rows)
    for (const std::vector<double>& row : *rows) d.surface.hinge.push_back({row[0], row[1]});
  else d.surface.hinge = {{(*from)[0], (*from)[1]}, {(*to)[0], (*to)[1]}};
  d.surface.kind = control.kind == "leading_edge" ? ControlKind::leading_edge
                   : control.kind == "all_moving" ? ControlKind::all_moving
                                                  : ControlKind::trailing_edge;
  const bool has_other_side = wing->is_symmetric || wing->has_mirror_image;
  d.other_side = !has_other_side || control.other_side == "none" ? OtherSide::none : control.other_side == "same" ? OtherSide::same : OtherSide::opposite;
  d.surface.has_image = d.other_side != OtherSide::none;
  if (is_deflected) {
    d.angle = deflect.angle;
    d.gap = deflect.gap == "open" ? ControlGap::open : ControlGap::sealed;
    if (!is_automatic(deflect.fairing)) d.fairing = deflect.fairing;
  }
  d.surface = from_root(*wing, d.surface);
  component->deflections.push_back(std::move(d));
  return component;
}

}  // namespace

ScriptValue deflect_wing(const ScriptCall& call) { return change_wing(call, true); }
ScriptValue control_wing(const ScriptCall& call) { return change_wing(call, false); }

std::string control_help() {
  ControlOptions control;
  return options_help(sterna::options_of(control)) +
         "  from = {span, chord}, to = {span, chord}\n      ends of the hinge: part of the span from the root, part of the chord from the leading edge\n" +
         "  hinge = {{span, chord}, ...}\n      in place of from and to: a hinge of several straight pieces\n";
}
std::string deflect_help() {
  DeflectOptions deflect;
  return options_help(sterna::options_of(deflect)) + control_help();
}

}  // namespace sterna::scripting
