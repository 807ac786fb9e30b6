// The entries that the tables of mesh:su2_config and mesh:foam_case share: reference = ..., moment_origin = ..., boundaries = { ... }.
#pragma once

#include <string>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/verbs/solver_case.h"

namespace sterna::scripting {

/// Of an aircraft or a wing, with what the options name instead; notes problems.
CaseReference read_case_reference(const ScriptCall& call, TableReader& reader, const CaseOptions& options);
/// Notes problems.
CaseBoundaries read_case_boundaries(TableReader& reader);

/// Help of the options, of the flow and of these entries.
std::string solver_case_help();

}  // namespace sterna::scripting
