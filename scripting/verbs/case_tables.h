// The entries that the tables of mesh:su2_config and mesh:foam_case share: reference = ..., moment_origin = ..., boundaries = { ... }, kinds = { ... }.
#pragma once

#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/verbs/solver_case.h"

namespace sterna::scripting {

/// Of an aircraft or a wing, with what the options name instead; notes problems.
CaseReference read_case_reference(const ScriptCall& call, TableReader& reader, const CaseOptions& options);
/// Notes problems.
CaseBoundaries read_case_boundaries(TableReader& reader);

/// kinds = { ["top*"] = "slip" }: notes problems.
std::vector<CaseKind> read_case_kinds(TableReader& reader);
/// Of a model in a file, for the command line: area, mean chord and quarter-chord point of its wing.
/// \throws Error of read_model; (bad_argument) where it has no such wing
CaseReference reference_of_model(const std::string& file, const CaseOptions& options, const RunContext& context);
/// What the options say of it instead.
void set_reference(const CaseOptions& options, CaseReference& reference);

/// Help of the options, of the flow and of these entries.
std::string solver_case_help();

}  // namespace sterna::scripting
