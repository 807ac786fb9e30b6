#include "scripting/values/flow_verbs.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

#include "geom/base/error.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/verbs.h"
#include "volmesh/flow/boundary_layer.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_flow_usage =
    "flow{ mach = 0.78, altitude = 11000, length = 4.2 }  or  flow{ speed = 60, temperature = 293, pressure = 101325, length = 0.3 }  or  flow{ reynolds = "
    "5e6, length = 7 }";
constexpr std::string_view k_y_plus_usage =
    "y_plus{ 1, mach = 0.78, altitude = 11000, length = 4.2 }  or  y_plus{ 1, flow{ reynolds = 5e6, length = 7 }, at = \"cell_centre\", law = \"ittc57\" }";
constexpr std::string_view k_boundary_layer_usage =
    "boundary_layer{ mach = 0.78, altitude = 11000, length = 4.2, factor = 1.3 }  or  boundary_layer{ flow{ reynolds = 5e6, length = 7 } }";
constexpr std::string_view k_y_plus_text = "--first-height \"y_plus 1 mach=0.78 altitude=11000 length=4.2\"";
constexpr std::string_view k_boundary_layer_text = "--total-height \"boundary_layer factor=1.3 reynolds=6e6 length=1\"";

QuantityValue first_height_value(const volmesh::FirstHeightOptions& options, const volmesh::FlowState& flow) {
  const volmesh::FirstHeight first = volmesh::first_height(options, flow);
  return {.verb = "y_plus",
          .metres = first.height,
          .text = describe(first),
          .flow = flow,
          .fields = {{"height", first.height},
                     {"y_plus", first.y_plus},
                     {"wall_distance", first.wall_distance},
                     {"skin_friction", first.skin_friction},
                     {"friction_velocity", first.friction_velocity}}};
}

QuantityValue thickness_value(const volmesh::ThicknessOptions& options, const volmesh::FlowState& flow) {
  const double thickness = volmesh::layer_thickness(options, flow);
  return {.verb = "boundary_layer",
          .metres = thickness,
          .text = volmesh::describe_thickness(options, flow),
          .flow = flow,
          .fields = {{"height", thickness}, {"thickness", thickness / options.factor}}};
}

ScriptValue as_value(QuantityValue value, const ScriptCall& call) {
  call.session.context.info(value.text);
  return std::make_shared<const QuantityValue>(std::move(value));
}

/// Reports errors of the flow relations with the user's file:line.
template <class F>
auto at_call(const ScriptCall& call, const F& work) {
  try {
    return work();
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = call.attempted();
    throw Error(std::move(info));
  }
}

void require_y_plus(TableReader& reader, volmesh::FirstHeightOptions& options) {
  const std::vector<ScriptValue>& items = reader.items();
  const auto number = items.empty() ? std::nullopt : number_of(items.front());
  if (!items.empty() && !number) {
    reader.add_problem("entry 1: expected the target y+, not " + std::string(type_text(items.front())));
    return;
  }
  if (number && !is_automatic(options.y_plus)) reader.add_problem("y_plus: given twice");
  if (number) {
    const OptionTable table = sterna::options_of(options);
    try {
      set_option(find_option(table, "y_plus", "y_plus"), *number);
    } catch (const Error& error) {
      reader.add_problem("entry 1: " + error.info().problem);
    }
  } else if (is_automatic(options.y_plus)) {
    reader.add_problem("needs the target y+ as the first entry");
  }
}

ScriptValue make_y_plus(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_y_plus_usage);
  TableReader reader(table, call.attempted());
  volmesh::FirstHeightOptions options;
  reader.read_options(sterna::options_of(options));
  require_y_plus(reader, options);
  const auto flow = read_flow(reader, 1);
  reader.finish();
  return as_value(at_call(call, [&] { return first_height_value(options, *flow); }), call);
}

ScriptValue make_boundary_layer(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_boundary_layer_usage);
  TableReader reader(table, call.attempted());
  volmesh::ThicknessOptions options;
  reader.read_options(sterna::options_of(options));
  const auto flow = read_flow(reader, 0);
  reader.finish();
  return as_value(at_call(call, [&] { return thickness_value(options, *flow); }), call);
}

ScriptValue make_flow(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_flow_usage);
  TableReader reader(table, call.attempted());
  const auto flow = read_flow(reader, 0);
  reader.finish();
  return as_value({.verb = "flow", .text = "flow: " + describe(*flow), .flow = *flow}, call);
}

ScriptValue quantity_field(const ScriptCall& call) {
  const QuantityValue& quantity = *self<QuantityHandle>(call);
  Fields fields;
  const auto add = [&](const std::string& name, double value) {
    if (!is_automatic(value)) fields.emplace_back(name, value);
  };
  for (const auto& [name, value] : quantity.fields) add(name, value);
  const volmesh::FlowState& flow = quantity.flow;
  add("reynolds", flow.reynolds);
  add("length", flow.length);
  add("mach", flow.mach);
  add("speed", flow.speed);
  add("temperature", flow.temperature);
  add("pressure", flow.pressure);
  add("density", flow.density);
  add("viscosity", flow.viscosity);
  add("altitude", flow.altitude);
  return select_field(call, std::move(fields), {});
}

std::string flow_help() {
  volmesh::FlowConditions conditions;
  return options_help(flow_options(conditions));
}
std::string y_plus_help() {
  volmesh::FirstHeightOptions options;
  return options_help(sterna::options_of(options)) + flow_help();
}
std::string boundary_layer_help() {
  volmesh::ThicknessOptions options;
  return options_help(sterna::options_of(options)) + flow_help();
}

constexpr std::array<ScriptVerb, 3> k_flow_verbs = {{
    {"flow", k_flow_usage,
     "Defines flow conditions: Reynolds number, speed and state of the gas, for y_plus, boundary_layer, mesh:su2_config and mesh:foam_case.", make_flow,
     flow_help, false, "quantity"},
    {"y_plus", k_y_plus_usage,
     "Computes the first height for a target y+ on a turbulent flat plate, in metres; printing the value shows its derivation. On the command line: "
     "--first-height \"y_plus 1 mach=0.78 altitude=11000 length=4.2\".",
     make_y_plus, y_plus_help, false, "quantity"},
    {"boundary_layer", k_boundary_layer_usage,
     "Computes the thickness of a turbulent boundary layer, for the total height of layers, in metres; printing the value shows its derivation. On the command "
     "line: --total-height \"boundary_layer factor=1.3 reynolds=6e6 length=1\".",
     make_boundary_layer, boundary_layer_help, false, "quantity"},
}};

}  // namespace

const ScriptVerb k_quantity_field = {"quantity", "", "", quantity_field};

std::span<const ScriptVerb> flow_verbs() { return k_flow_verbs; }

OptionTable flow_options(volmesh::FlowConditions& conditions) { return sterna::options_of(conditions); }

std::optional<volmesh::FlowState> read_flow(TableReader& reader, std::size_t first_item) {
  volmesh::FlowConditions conditions;
  const OptionTable table = flow_options(conditions);
  const bool is_named = reader.read_options(table) > 0;
  const std::vector<ScriptValue>& items = reader.items();
  if (items.size() > first_item + 1)
    reader.add_problem("entry " + std::to_string(first_item + 2) + ": unexpected, only one entry with flow conditions is allowed");
  if (items.size() > first_item) {
    const auto* quantity = std::get_if<QuantityHandle>(&items[first_item]);
    if (!quantity)
      reader.add_problem("entry " + std::to_string(first_item + 1) + ": expected flow conditions (from flow{...}), not " +
                         std::string(type_text(items[first_item])));
    else if (is_named) reader.add_problem("flow conditions are given twice, as entry " + std::to_string(first_item + 1) + " and by name");
    else return (*quantity)->flow;
    return std::nullopt;
  }
  if (reader.has_problems()) return std::nullopt;
  try {
    return volmesh::flow_state(conditions);
  } catch (const Error& error) {
    reader.add_problem(error.info().problem + (error.info().hint.empty() ? "" : " (" + error.info().hint + ")"));
    return std::nullopt;
  }
}

bool is_flow_text(std::string_view text) { return text.starts_with("y_plus ") || text.starts_with("boundary_layer "); }

QuantityValue quantity_of_text(const std::string& text) {
  std::istringstream words(text);
  std::string verb;
  words >> verb;
  const bool is_first_height = verb == "y_plus";
  volmesh::FirstHeightOptions first;
  volmesh::ThicknessOptions thickness;
  volmesh::FlowConditions conditions;
  OptionTable table = is_first_height ? sterna::options_of(first) : sterna::options_of(thickness);
  for (Option& option : flow_options(conditions)) table.push_back(std::move(option));
  const std::string attempted = "reading \"" + text + "\"";
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos && is_first_height && is_automatic(first.y_plus)) set_option_as_typed(find_option(table, "y_plus", attempted), word);
    else if (equals == std::string::npos || equals == 0)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = attempted,
                   .problem = "\"" + word + "\" is not NAME=VALUE",
                   .hint = std::string(is_first_height ? k_y_plus_text : k_boundary_layer_text)});
    else set_option_as_typed(find_option(table, word.substr(0, equals), attempted), word.substr(equals + 1));
  }
  if (is_first_height && is_automatic(first.y_plus))
    throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = "the target y+ is missing", .hint = std::string(k_y_plus_text)});
  try {
    const volmesh::FlowState flow = volmesh::flow_state(conditions);
    return is_first_height ? first_height_value(first, flow) : thickness_value(thickness, flow);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = attempted;
    throw Error(std::move(info));
  }
}

}  // namespace sterna::scripting
