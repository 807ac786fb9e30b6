// The verb actuator_disc{...}, and reading of discs from a verb's table, from the command line and from the files of stages.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "volmesh/case/actuator_disc.h"

namespace sterna::scripting {

/// The verb actuator_disc. Its value is a table with the field "shape".
std::span<const ScriptVerb> disc_verbs();

/// Reads the entry "interfaces" of a table: one value of actuator_disc{...} or a list of them. Notes problems with the reader.
std::vector<volmesh::ActuatorDisc> read_interfaces(TableReader& reader, const ScriptCall& call);

/// Parses a disc of the command line, "prop center=0,0,0 axis=1,0,0 radius=1.2 inner_radius=0.3 edge=5cm": its name, then named numbers. Numbers take units.
/// \throws Error(bad_argument, unknown_option)
volmesh::ActuatorDisc disc_of_text(const std::string& text);

}  // namespace sterna::scripting
