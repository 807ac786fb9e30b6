// The verb wake_sheet{...}, and reading of wake sheets from a verb's table, from the command line and from the files of stages.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "volmesh/case/wake_sheet.h"

namespace sterna::scripting {

/// The verb wake_sheet. Its value is a table with the field "shape".
std::span<const ScriptVerb> wake_verbs();

/// Reads the entry "wakes" of a table: one value of wake_sheet{...}, a list of them, or "auto" for sheets behind all trailing edges. Notes problems with the
/// reader.
std::vector<volmesh::WakeSheet> read_wakes(TableReader& reader, const ScriptCall& call);

/// Parses wake sheets of the command line, "wing=main* length=2 growth=1.2 direction=1,0,0", or "auto".
/// \throws Error(bad_argument, unknown_option)
volmesh::WakeSheet wake_sheet_of_text(const std::string& text);

}  // namespace sterna::scripting
