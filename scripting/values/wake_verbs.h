// The verb wake_sheet{...}, and reading wake sheets back from a verb's table, from the command line and from the files of stages.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "volmesh/case/wake_sheet.h"

namespace sterna::scripting {

/// wake_sheet. The value is a table with the field "shape".
std::span<const ScriptVerb> wake_verbs();

/// The entry "wakes" of a table: a list of what wake_sheet{...} made, or one, or "auto": behind all trailing edges. Notes problems with the reader.
std::vector<volmesh::WakeSheet> read_wakes(TableReader& reader, const ScriptCall& call);

/// Wake sheets of the command line, "wing=main* length=2 growth=1.2 direction=1,0,0", or "auto".
/// \throws Error(bad_argument, unknown_option)
volmesh::WakeSheet wake_sheet_of_text(const std::string& text);

/// Wake sheets as a JSON list, for manifests and the files of stages; and back.
/// \throws Error(bad_argument) for text that is none
std::string wakes_json(const std::vector<volmesh::WakeSheet>& wakes);
std::vector<volmesh::WakeSheet> wakes_of_json(const std::string& text);

}  // namespace sterna::scripting
