// The entries common to the tables of mesh:su2_config and mesh:foam_case: reference = ..., moment_origin = ..., boundaries = { ... }, kinds = { ... }.
#pragma once

#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/verbs/solver_case.h"

namespace sterna::scripting {

/// Reads the reference values of an aircraft or a wing; values in the options replace them. Notes problems.
CaseReference read_case_reference(const ScriptCall& call, TableReader& reader, const CaseOptions& options);
/// Reads the entry `boundaries`; notes problems.
CaseBoundaries read_case_boundaries(TableReader& reader);

/// Reads kinds = { ["top*"] = "slip" }; notes problems.
std::vector<CaseKind> read_case_kinds(TableReader& reader);
/// Returns the reference values of a model in a file, for the command line: area, mean chord and quarter-chord point of its wing.
/// \throws Error of read_model; (bad_argument) if it has no such wing
CaseReference reference_of_model(const std::string& file, const CaseOptions& options, const RunContext& context);
/// Replaces the reference values that are set in the options.
void set_reference(const CaseOptions& options, CaseReference& reference);

/// Returns the help on the options, the flow and these entries.
std::string solver_case_help();

}  // namespace sterna::scripting
