#include "scripting/values/disc_verbs.h"

#include <array>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/typed_number.h"

namespace sterna::scripting {

namespace {

using volmesh::ActuatorDisc;

constexpr std::string_view k_disc_usage =
    "actuator_disc{ name = \"prop\", center = {-0.4, 0, 0}, axis = {1, 0, 0}, radius = 1.2, inner_radius = 0.25, edge = 0.05 }";

ActuatorDisc disc_of(const ScriptTable& table, const std::string& attempted) {
  ActuatorDisc disc;
  const OptionTable options = sterna::options_of(disc);
  TableReader reader(table, attempted);
  reader.field("shape");
  refuse_items_beyond(reader, 0);
  reader.read_options(options);
  reader.require(options);
  reader.finish();
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
  ActuatorDisc disc;
  return options_help(sterna::options_of(disc));
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
  ActuatorDisc disc;
  const OptionTable options = sterna::options_of(disc);
  const std::vector<std::string> names = set_options_as_typed(options, text, attempted);
  if (names.size() != 1 || !text.starts_with(names.front()))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = attempted,
                 .problem = "the first word must be the name of the disc; all others are NAME=VALUE",
                 .hint = "such as \"prop center=0,0,0 radius=1.2\""});
  disc.name = names.front();
  require_options(options, attempted);
  return disc;
}

}  // namespace sterna::scripting
