// Limits of the QUALITY gates as given by users: gates = { orthogonality = { hard = 3*deg, target = 15*deg }, face_weight = false }.
#pragma once

#include <string>
#include <string_view>

#include "geom/mesh/gates.h"
#include "scripting/lua/table_reader.h"

namespace sterna::scripting {

/// Reads the entry `gates` of a table. Keys are names of measures, or of a gate that has one measure ("G5"). The limits hard, target and usual are numbers
/// (angles in radians), or false for no limit; share is in [0, 1]. A measure that is false has no limits: it is displayed only. Notes problems. Returns true if
/// the entry exists.
bool read_gate_limits(TableReader& reader, GateTable& limits);

/// Sets limits from the command line: "orthogonality:hard=3deg,target=15deg", "face_weight:none".
/// \throws Error(bad_argument)
void set_gate_limits(std::string_view text, GateTable& limits);

/// Returns the measures with their limits, for help.
std::string gate_limits_help();

}  // namespace sterna::scripting
