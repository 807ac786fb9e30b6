#include "scripting/interpreter/script_args.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/number_with_unit.h"
#include "geom/base/schema.h"
#include "scripting/interpreter/declared_arguments.h"
#include "scripting/interpreter/script_verbs.h"
#include "scripting/lua/script_watch.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/geometry_tools.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_script_args_usage = "local p = args{ alpha = 0, half = false, name = \"polar\" }";
constexpr std::string_view k_number_usage =
    "args{ span = number{ 10, min = 6, max = 20, unit = m }, alpha = number{ 4, min = -5, max = 15, step = 0.5, unit = deg } }";
/// Field of the table returned by number{}, by which that table is distinguished from tables of the script.
constexpr const char* k_number_mark = "argument";

bool is_name(std::string_view text) {
  return !text.empty() && !std::isdigit(static_cast<unsigned char>(text.front())) &&
         std::all_of(text.begin(), text.end(), [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)); });
}

/// Parses "4", "2.5mm", "10*deg", "288K" to a number in SI. A number without a unit is unchanged, because only the script defines its unit (number{}).
std::optional<double> number_of_text(const std::string& text) {
  for (const Unit unit : {Unit::metre, Unit::radian, k_kelvin}) {
    try {
      return parse_number_with_unit(text, unit, BareAngle::radians);  // a plain number is parsed as a length, which leaves it unchanged
    } catch (const Error&) {
      continue;  // this is no number, or its unit has another dimension; the caller tries other interpretations
    }
  }
  return std::nullopt;
}

/// Converts a string to the value that it represents.
ScriptValue value_of(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  if (const auto number = number_of_text(text)) {
    if (text.find_first_not_of("+-0123456789") == std::string::npos && *number == static_cast<double>(static_cast<std::int64_t>(*number)))
      return static_cast<std::int64_t>(*number);
    return *number;
  }
  return text;
}

/// Converts the string to a value of the same type as `like`; notes a problem if this is impossible.
ScriptValue value_like(const std::string& name, const std::string& text, const ScriptValue& like, TableReader& reader) {
  if (std::holds_alternative<std::string>(like)) return text;
  ScriptValue value = value_of(text);
  const bool is_number = std::holds_alternative<std::int64_t>(value) || std::holds_alternative<double>(value),
             needs_number = std::holds_alternative<std::int64_t>(like) || std::holds_alternative<double>(like);
  if (needs_number ? !is_number : value.index() != like.index())
    reader.add_problem("argument " + name + "=" + text + ": expected " + (needs_number ? "a number, also with a unit: 4, 2.5mm, 10deg" : "true or false"));
  return value;
}

bool is_value(const ScriptValue& value) {
  return std::holds_alternative<bool>(value) || std::holds_alternative<std::int64_t>(value) || std::holds_alternative<double>(value) ||
         std::holds_alternative<std::string>(value);
}

/// Returns "deg" for the value of a unit.
std::string unit_name(double value) {
  for (const ScriptUnit& unit : script_units())
    if (unit.value == value) return unit.name;
  return {};
}

const std::string* given(const ScriptCall& call, std::string_view name) {
  for (const auto& [given_name, text] : call.session.arguments)
    if (given_name == name) return &text;
  return nullptr;
}

/// Returns the parameter from a value of number{}; nothing for other values.
std::optional<ScriptParameter> number_parameter(const std::string& name, const ScriptValue& value) {
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table || !*table || !(*table)->fields.contains(k_number_mark)) return std::nullopt;
  const auto field = [&](const char* key) -> std::optional<double> {
    const auto found = (*table)->fields.find(key);
    return found == (*table)->fields.end() ? std::nullopt : number_of(found->second);
  };
  ScriptParameter parameter{.name = name, .initial = {}, .value = {}, .min = field("min"), .max = field("max"), .step = field("step")};
  parameter.unit_value = field("unit").value_or(1.0);
  if (field("unit")) parameter.unit = unit_name(parameter.unit_value);
  parameter.initial = *field(k_number_mark) * parameter.unit_value;
  parameter.value = parameter.initial;
  return parameter;
}

/// Sets the parameter from a string to a value within the limits. A plain number is in the parameter's unit. Otherwise notes a problem.
void set_number_parameter(ScriptParameter& parameter, const std::string& text, TableReader& reader) {
  const ScriptValue value = value_like(parameter.name, text, parameter.initial, reader);
  const auto number = number_of(value);
  if (!number) return;
  const bool is_bare = text.find_first_not_of("+-0123456789.eE") == std::string::npos;
  const double in_unit = is_bare ? *number : *number / parameter.unit_value;
  const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
  const double slack = 1e-9 * std::max(std::abs(parameter.min.value_or(0.0)), std::abs(parameter.max.value_or(0.0)));  // 20deg is 20 up to rounding
  if (parameter.min && in_unit < *parameter.min - slack)
    reader.add_problem("argument " + parameter.name + "=" + text + ": " + number_text(in_unit, 6) + unit + " is below the minimum, " +
                       number_text(*parameter.min, 6) + unit);
  if (parameter.max && in_unit > *parameter.max + slack)
    reader.add_problem("argument " + parameter.name + "=" + text + ": " + number_text(in_unit, 6) + unit + " is above the maximum, " +
                       number_text(*parameter.max, 6) + unit);
  parameter.value = in_unit * parameter.unit_value;
}

/// Makes number{ 10, min = 6, max = 20, unit = m }, which is a default with limits for args{}.
ScriptValue declare_number(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_number_usage);
  TableReader reader(table, call.attempted());
  auto result = std::make_shared<ScriptTable>();
  const std::vector<ScriptValue>& items = reader.items();
  const auto initial = items.size() == 1 ? number_of(items.front()) : std::nullopt;
  if (!initial) reader.add_problem("entry 1: expected the default, a number");
  else result->fields[k_number_mark] = *initial;
  for (const char* name : {"min", "max", "step", "unit"}) {
    const ScriptValue* value = reader.field(name);
    if (!value) continue;
    const auto number = number_of(*value);
    const bool is_positive = name[0] == 's' || name[0] == 'u';
    if (!number || !std::isfinite(*number) || (is_positive && *number <= 0.0))
      reader.add_problem(std::string(name) + ": expected a number" + (is_positive ? " above 0" : ""));
    else result->fields[name] = *number;
  }
  if (!reader.has_problems()) {
    const ScriptParameter made = *number_parameter("", TableHandle(result));
    if (made.min && made.max && *made.min >= *made.max) reader.add_problem("min: must be below max");
    if (made.min && *initial < *made.min) reader.add_problem("the default " + number_text(*initial, 6) + " is below min");
    if (made.max && *initial > *made.max) reader.add_problem("the default " + number_text(*initial, 6) + " is above max");
  }
  reader.finish();
  return TableHandle(std::move(result));
}

/// Declares args{ alpha = 0, "name" }: named entries are defaults; strings without a key are required arguments.
ScriptValue declare(const ScriptCall& of_table) {
  ScriptCall call = of_table;
  call.arguments.erase(call.arguments.begin());  // removes the called table
  const ScriptTable table = table_argument(call, 0, k_script_args_usage);
  TableReader reader(table, call.attempted());
  ScriptTable result;
  std::vector<ScriptParameter> declared;
  for (const auto& [name, value] : table.fields) {
    reader.field(name);
    if (std::optional<ScriptParameter> number = number_parameter(name, value)) {
      if (const std::string* text = given(call, name)) set_number_parameter(*number, *text, reader);
      result.fields[name] = number->value;
      declared.push_back(std::move(*number));
      continue;
    }
    if (!is_value(value)) reader.add_problem(name + ": expected a number, a string, true or false as the default, not " + std::string(type_text(value)));
    const std::string* text = given(call, name);
    result.fields[name] = text && is_value(value) ? value_like(name, *text, value, reader) : value;
    declared.push_back({.name = name, .initial = value, .value = result.fields[name], .min = {}, .max = {}, .step = {}});
  }
  for (const ScriptValue& item : reader.items()) {
    const auto* name = std::get_if<std::string>(&item);
    if (!name || !is_name(*name)) {
      reader.add_problem("expected the name of an argument, not " + std::string(name ? "\"" + *name + "\"" : type_text(item)));
      continue;
    }
    if (const std::string* text = given(call, *name)) result.fields[*name] = value_of(*text);
    else if (call.session.check) result.fields[*name] = std::int64_t{1};  // any value is valid
    else reader.add_problem("argument " + *name + " is missing: sterna run " + call.session.script.filename().string() + " " + *name + "=VALUE");
    declared.push_back({.name = *name, .initial = {}, .value = result.fields[*name], .min = {}, .max = {}, .step = {}});
  }
  for (const std::string& problem : add_declared(call.session, call.where, std::move(declared))) reader.add_problem(problem);
  const std::vector<std::string> unknown = unknown_arguments(call.session, false);
  for (const std::string& problem : unknown) reader.add_problem(problem);
  call.session.declared.is_refused |= !unknown.empty();
  if (call.session.watch) call.session.watch->declared(call.session.declared.list, !unknown.empty());
  reader.finish();
  return std::make_shared<const ScriptTable>(std::move(result));
}

/// Reads args.alpha.
ScriptValue read_argument(const ScriptCall& call) {
  const auto* name = call.arguments.size() < 2 ? nullptr : std::get_if<std::string>(&call.arguments[1]);
  if (!name) reject(call, "the name of an argument must be a string", std::string(k_script_args_usage));
  if (const std::string* text = given(call, *name)) return value_of(*text);
  if (call.session.check) return std::int64_t{1};
  std::vector<std::string> known;
  for (const auto& [given_name, text] : call.session.arguments) known.push_back(given_name);
  const std::string nearest = nearest_name(*name, known);
  reject(call, "argument " + *name + " was not given" + (nearest.empty() ? "" : ", but " + nearest + " was"),
         "sterna run " + call.session.script.filename().string() + " " + *name + "=VALUE, or a default in the script: args{ " + *name + " = 0 }." + *name);
}

constexpr std::array<ScriptVerb, 2> k_script_args_verbs = {{
    {"args", k_script_args_usage,
     "Returns the arguments of the command line, `sterna run case.lua alpha=4 height=2mm half=true`. Names with defaults are optional, names as strings are "
     "required. args.alpha reads a single argument. A script and its modules can each call args{}.",
     declare},
    {"number", k_number_usage,
     "Defines an argument of args{} with default, limits and unit. The unit applies to default, limits and numbers without unit on the command line; the "
     "script gets the value in SI. `sterna view` shows a slider.",
     declare_number},
}};

}  // namespace

const ScriptVerb k_argument_field = {"args", "", "", read_argument};

std::span<const ScriptVerb> argument_verbs() { return k_script_args_verbs; }

const ScriptVerb& arguments_verb() {
  for (const ScriptVerb& verb : script_verbs())
    if (verb.name == k_script_args_verbs.front().name) return verb;
  return k_script_args_verbs.front();
}

std::pair<std::string, std::string> split_argument(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || !is_name(std::string_view(text).substr(0, equals)))
    throw Error({.code = ErrorCode::bad_argument, .attempted = "argument \"" + text + "\"", .problem = "is not NAME=VALUE, as in alpha=4"});
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace sterna::scripting
