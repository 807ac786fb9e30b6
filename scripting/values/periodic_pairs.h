// Reads pairs of matching patches, periodic = { { "left", "right" } }, from a verb's table, from the command line and from the files of stages.
#pragma once

#include <string>
#include <vector>

#include "geom/mesh/periodic_names.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/option_json.h"

namespace sterna::scripting {

/// Reads the entry "periodic" of a table: a list of pairs of names, or one pair. Notes problems with the reader.
std::vector<PeriodicNames> read_periodic(TableReader& reader);

/// Parses a pair of the command line, "left,right".
/// \throws Error(bad_argument)
PeriodicNames periodic_of_text(const std::string& text);

/// periodic_json returns pairs as a JSON list of lists, for manifests and the files of stages; the second function reads it.
/// \throws Error(bad_argument) if the JSON is no such list
Json periodic_json(const std::vector<PeriodicNames>& pairs);
std::vector<PeriodicNames> periodic_of_json(const Json& list);

}  // namespace sterna::scripting
