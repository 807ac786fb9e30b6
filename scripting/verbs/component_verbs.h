// Verbs that describe components of an aircraft (wing{}, fuselage{}, nacelle{} and so on), and the verb that combines them: aircraft{}.
#pragma once

#include <span>
#include <string>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// The verbs fuselage, nacelle, boom, fairing, body_of_revolution, sting, pylon, wing, aircraft.
std::span<const ScriptVerb> component_verbs();
std::span<const ScriptVerb> component_methods();
extern const ScriptVerb k_component_field;

/// Returns a one-line description: "Wing \"main\": 2 x 3 sections, span 34.1 m, area 122 m^2".
std::string describe(const ComponentValue& component);

/// The verbs by subject; each takes one table.
ScriptValue make_wing_verb(const ScriptCall& call);
ScriptValue make_fuselage_verb(const ScriptCall& call);
ScriptValue make_nacelle_verb(const ScriptCall& call);
ScriptValue make_pylon_verb(const ScriptCall& call);
ScriptValue make_boom_verb(const ScriptCall& call);
ScriptValue make_fairing_verb(const ScriptCall& call);
ScriptValue make_revolution_verb(const ScriptCall& call);
ScriptValue make_sting_verb(const ScriptCall& call);
std::string wing_help();
std::string fuselage_help();
std::string nacelle_help();
std::string pylon_help();
std::string boom_help();
std::string fairing_help();
std::string revolution_help();
std::string sting_help();
std::string deflect_help();
std::string control_help();

/// Usage lines, for verbs and messages.
inline constexpr std::string_view k_wing_usage =
    "wing{ name = \"wing\", symmetric = true, position = {12, 0, -1}, sections = { { y = 0, chord = 6, airfoil = \"naca23012\" }, { y = 15, chord = 2, sweep = "
    "25*deg, dihedral = 5*deg } }, tip = \"round\" }";
inline constexpr std::string_view k_fuselage_usage =
    "fuselage{ name = \"body\", frames = { { x = 0, diameter = 0.4 }, { x = 5, width = 4, height = 4.2, shape = \"superellipse\", exponent = 2.4 }, { x = 35, "
    "diameter = 0.6, z = 1 } } }";
inline constexpr std::string_view k_nacelle_usage =
    "nacelle{ name = \"engine\", symmetric = true, position = {11, 5, -1.5}, length = 3.6, diameter = 2.1, intake = \"fan_face\", exhaust = \"nozzle\" }";
inline constexpr std::string_view k_pylon_usage = "pylon{ main_wing, engine, thickness = 0.1 }";
inline constexpr std::string_view k_boom_usage = "boom{ name = \"boom\", from = {3, 0, 0}, to = {9, 0, 0.4}, diameter = 0.3 }";
inline constexpr std::string_view k_fairing_usage = "fairing{ name = \"belly\", position = {11, 0, -1.4}, length = 9, width = 3.4, height = 2 }";
inline constexpr std::string_view k_revolution_usage =
    "body_of_revolution{ name = \"tank\", position = {2, 3, -1}, profile = { {0, 0}, {0.5, 0.2}, {3, 0.25}, {4, 0} } }";
inline constexpr std::string_view k_sting_usage = "sting{ from = {1.1, 0, 0}, to = {2.5, 0, 0}, diameter = 0.06, cone_start = 0.4, end_diameter = 0.1 }";
inline constexpr std::string_view k_deflect_usage =
    "main_wing:deflect{ \"aileron\", from = {0.72, 0.75}, to = {0.95, 0.72}, angle = 10*deg, gap = \"sealed\" }";
inline constexpr std::string_view k_control_usage = "main_wing:control{ \"aileron\", from = {0.72, 0.75}, to = {0.95, 0.72} }";

/// The methods wing:deflect and wing:control (control_verbs.cpp).
ScriptValue deflect_wing(const ScriptCall& call);
ScriptValue control_wing(const ScriptCall& call);

}  // namespace sterna::scripting
