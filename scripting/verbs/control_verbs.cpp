// wing:deflect{} and wing:control{}, and deflections of control surfaces that are described by files.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "geom/model/deflection.h"
#include "scripting/lua/component_value.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/verbs/component_verbs.h"
#include "scripting/verbs/control_options.h"

namespace sterna::scripting {
namespace {

ScriptValue change_wing(const ScriptCall& call, bool is_deflected) {
  const std::string_view usage = is_deflected ? k_deflect_usage : k_control_usage;
  const ComponentHandle& component = self<ComponentHandle>(call);
  const auto* wing = std::get_if<Wing>(&component->shape);
  if (!wing) reject(call, "applies to wings, not to " + std::string(component->type_text()));
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
  constexpr std::string_view k_pair = "{fraction of the span from the root, fraction of the chord}";
  const auto from = read_pair(reader, "from", k_pair), to = read_pair(reader, "to", k_pair);
  const ScriptValue* hinge = reader.field("hinge");
  const auto rows = hinge ? rows_of(*hinge, 2) : std::nullopt;
  if (hinge && !rows) reader.add_problem("hinge: expected a list of points {{span, chord}, ...}");
  const bool has_both = table.fields.contains("from") && table.fields.contains("to"), has_any = table.fields.contains("from") || table.fields.contains("to");
  if (hinge ? has_any : !has_both) reader.add_problem("needs from and to, or hinge = {{span, chord}, ...}: " + std::string(usage));
  const auto require_within = [&](const std::string& what, double span, double chord) {
    if (!(span >= 0.0 && span <= 1.0))
      reader.add_problem(what + fmt::format(": {:g} is outside the wing: fractions of its span are 0 at the root to 1 at the tip", span));
    if (!(chord >= 0.0 && chord <= 1.0))
      reader.add_problem(what + fmt::format(": {:g} is outside the chord: its fractions are 0 at the leading edge to 1 at the trailing edge", chord));
  };
  if (from) require_within("from", (*from)[0], (*from)[1]);
  if (to) require_within("to", (*to)[0], (*to)[1]);
  if (from && to && (*from)[0] == (*to)[0]) reader.add_problem("from and to are at the same fraction of the span");
  if (rows)
    for (const std::vector<double>& row : *rows) require_within("hinge", row[0], row[1]);
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
  d.other_side = has_other_side ? other_side_of(control.other_side) : OtherSide::none;
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

/// Returns the options of one setting. Kinds and positions are not among them, because the file defines them.
OptionTable setting_options(DeflectOptions& deflect, ControlOptions& control) {
  OptionTable options = sterna::options_of(deflect);
  for (Option& option : sterna::options_of(control))
    if (option.name == "other_side") options.push_back(std::move(option));
  return options;
}

}  // namespace

OtherSide other_side_of(const std::string& choice) { return choice == "none" ? OtherSide::none : choice == "same" ? OtherSide::same : OtherSide::opposite; }

std::vector<ControlSetting> read_control_settings(const ScriptTable& table, const std::string& where, TableReader& reader) {
  std::vector<ControlSetting> settings;
  if (!table.items.empty() || !table.other_keys.empty() || table.fields.empty())
    reader.add_problem(
        where + ": expected a table with names of control surfaces as keys and angles as values, { Elevator = 5*deg, [\"Flap*\"] = { angle = 20*deg } }");
  for (const auto& [names, value] : table.fields) {
    const std::string entry = where + "[\"" + names + "\"]";
    DeflectOptions deflect;
    ControlOptions control;
    const OptionTable schema = setting_options(deflect, control);
    const auto* inner = std::get_if<TableHandle>(&value);
    const ScriptTable alone{.items = {}, .fields = {{"angle", value}}, .other_keys = {}};
    TableReader entries(inner ? **inner : alone, entry);
    entries.read_options(schema);
    entries.require(schema);
    try {
      entries.finish();
    } catch (const Error& error) {
      reader.add_problem(entry + ": " + error.info().problem);
    }
    settings.push_back({.names = names,
                        .angle = is_automatic(deflect.angle) ? 0.0 : deflect.angle,
                        .gap = deflect.gap == "open" ? ControlGap::open : ControlGap::sealed,
                        .fairing = is_automatic(deflect.fairing) ? Deflection::k_automatic_fairing : deflect.fairing,
                        .other_side = other_side_of(control.other_side)});
  }
  return settings;
}

std::string control_settings_help() {
  DeflectOptions deflect;
  ControlOptions control;
  return "deflections = { Elevator = 5*deg, [\"Flap*\"] = { angle = 20*deg } }: deflects control surfaces (in sumo files: controls) that the file describes; "
         "each by an angle, or by a table of:\n" +
         options_help(setting_options(deflect, control));
}

ScriptValue deflect_wing(const ScriptCall& call) { return change_wing(call, true); }
ScriptValue control_wing(const ScriptCall& call) { return change_wing(call, false); }

std::string control_help() {
  ControlOptions control;
  return options_help(sterna::options_of(control)) +
         "  from = {span, chord}, to = {span, chord}\n      ends of the hinge: fraction of the span from the root, fraction of the chord from the leading "
         "edge\n" +
         "  hinge = {{span, chord}, ...}\n      instead of from and to: a hinge of several straight pieces\n";
}
std::string deflect_help() {
  DeflectOptions deflect;
  return options_help(sterna::options_of(deflect)) + control_help();
}

}  // namespace sterna::scripting
