#include "scripting/values/disc_verbs.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/typed_number.h"

namespace sterna::scripting {

/// Scalar options of an actuator disc.
struct DiscNumbers {
  std::string name = "disc";
  double radius = k_automatic;
  double inner_radius = 0.0;
  double edge = k_automatic;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::DiscNumbers> {
  using O = scripting::DiscNumbers;
  static constexpr std::string_view stage = "actuator_disc";
  static constexpr std::array fields = {
      Field<O>{.name = "name", .member = &O::name, .help = "name of the patch on the upstream side; the downstream patch is NAME.back"},
      Field<O>{.name = "radius",
               .member = &O::radius,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "outer radius: in the fluid, or inside the body around the disc (a duct that the disc fills)",
               .required = true},
      Field<O>{.name = "inner_radius",
               .member = &O::inner_radius,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "inner radius of a ring; 0: a full disc, or a disc that ends on walls with layers that pass through it (a spinner, a hub)"},
      Field<O>{.name = "edge",
               .member = &O::edge,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "longest edge of the disc's triangles",
               .automatic = "a twelfth of the radius"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

using volmesh::ActuatorDisc;
using PlainJson = nlohmann::json;

constexpr std::string_view k_disc_usage =
    "actuator_disc{ name = \"prop\", center = {-0.4, 0, 0}, axis = {1, 0, 0}, radius = 1.2, inner_radius = 0.25, edge = 0.05 }";

ActuatorDisc disc_of(const ScriptTable& table, const std::string& attempted) {
  ActuatorDisc disc;
  DiscNumbers numbers;
  const OptionTable options = sterna::options_of(numbers);
  TableReader reader(table, attempted);
  reader.field("shape");
  refuse_items_beyond(reader, 0);
  const auto center = read_point(reader, "center");
  if (center) disc.center = *center;
  else reader.add_problem("center: required, {x, y, z}");
  if (const auto axis = read_point(reader, "axis")) disc.axis = *axis;
  reader.read_options(options);
  reader.require(options);
  reader.finish();
  disc.name = numbers.name;
  disc.radius = numbers.radius;
  disc.inner_radius = numbers.inner_radius;
  disc.edge = numbers.edge;
  return disc;
}

ScriptValue make_disc(const ScriptCall& call) {
  if (call.arguments.size() != 1 || !std::holds_alternative<TableHandle>(call.arguments.front()))
    throw Error({.code = ErrorCode::bad_argument, .attempted = call.attempted(), .problem = "takes one table", .hint = std::string(k_disc_usage)});
  ScriptTable table = *std::get<TableHandle>(call.arguments.front());
  disc_of(table, call.attempted());
  table.fields["shape"] = std::string("actuator_disc");
  return std::make_shared<const ScriptTable>(std::move(table));
}

std::string disc_help() {
  DiscNumbers numbers;
  return options_help(sterna::options_of(numbers)) +
         "center = {x, y, z} in metres; axis = {x, y, z}: direction of the flow through the disc, by default {1, 0, 0}\n";
}

constexpr std::array<ScriptVerb, 1> k_disc_verbs = {{
    {"actuator_disc", k_disc_usage, "Disc or ring without thickness in the fluid, with a patch on each side, for the interfaces of volume_mesh.", make_disc,
     disc_help, false, "disc"},
}};

}  // namespace

std::span<const ScriptVerb> disc_verbs() { return k_disc_verbs; }

std::vector<ActuatorDisc> read_interfaces(TableReader& reader, const ScriptCall& call) {
  std::vector<ActuatorDisc> discs;
  for (const ShapeEntry& entry : read_shapes(reader, "interfaces", k_disc_usage)) {
    if (entry.shape == "actuator_disc") discs.push_back(disc_of(*entry.table, call.attempted() + ", " + entry.where));
    else reader.add_problem(entry.where + ": expected " + std::string(k_disc_usage) + ", not " + std::string(type_text(entry.value)));
  }
  return discs;
}

ActuatorDisc disc_of_text(const std::string& text) {
  const std::string attempted = "disc \"" + text + "\"";
  std::istringstream words(text);
  ScriptTable table;
  std::string name;
  if (!(words >> name) || name.find('=') != std::string::npos)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = attempted,
                 .problem = "the first word must be the name of the disc",
                 .hint = "such as \"prop center=0,0,0 radius=1.2\""});
  table.fields["name"] = name;
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = "\"" + word + "\" is not NAME=VALUE"});
    std::vector<ScriptValue> values;
    std::istringstream list(word.substr(equals + 1));
    const std::string key = word.substr(0, equals);
    for (std::string value; std::getline(list, value, ',');) values.push_back(typed_number(value, key == "axis" ? Unit::none : Unit::metre));
    ScriptValue& field = table.fields[key];
    if (values.size() == 1) field = values.front();
    else field = std::make_shared<const ScriptTable>(ScriptTable{.items = std::move(values), .fields = {}, .other_keys = {}});
  }
  return disc_of(table, attempted);
}

std::string discs_json(const std::vector<ActuatorDisc>& discs) {
  PlainJson list = PlainJson::array();
  for (const ActuatorDisc& disc : discs) {
    PlainJson entry = {{"name", disc.name},
                       {"center", {disc.center.x, disc.center.y, disc.center.z}},
                       {"axis", {disc.axis.x, disc.axis.y, disc.axis.z}},
                       {"radius", disc.radius},
                       {"inner_radius", disc.inner_radius}};
    if (!is_automatic(disc.edge)) entry["edge"] = disc.edge;
    list.push_back(std::move(entry));
  }
  return list.dump();
}

std::vector<ActuatorDisc> discs_of_json(const std::string& text) {
  std::vector<ActuatorDisc> discs;
  try {
    const auto vector_of = [](const PlainJson& list) { return Vec3{list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()}; };
    for (const PlainJson& entry : PlainJson::parse(text))
      discs.push_back({.name = entry.at("name").get<std::string>(),
                       .center = vector_of(entry.at("center")),
                       .axis = vector_of(entry.at("axis")),
                       .radius = entry.at("radius").get<double>(),
                       .inner_radius = entry.at("inner_radius").get<double>(),
                       .edge = entry.contains("edge") ? entry.at("edge").get<double>() : k_automatic});
  } catch (const PlainJson::exception& error) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = "reading actuator discs from JSON", .problem = error.what()});
  }
  return discs;
}

}  // namespace sterna::scripting
