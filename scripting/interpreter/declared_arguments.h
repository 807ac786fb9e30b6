// The arguments of a script and its modules together: each may call args{}.
#pragma once

#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/script_parameter.h"

namespace sterna::scripting {

/// Adds what the args{} at `where` ("case.lua:5: ") declares, in the order in which the source has it. An argument may be declared several times in the same
/// way. \return problems: names that were declared with another default or other limits before
std::vector<std::string> add_declared(ScriptSession& session, const std::string& where, std::vector<ScriptParameter> parameters);

/// Returns a problem for each argument of the command line that no args{} has declared. None before the first args{}, and none while a module that is not
/// loaded yet or an args{} that has not run yet may still declare it, unless the script is over.
std::vector<std::string> unknown_arguments(const ScriptSession& session, bool is_over);

/// Called before work that takes time and when the script is over.
/// \throws Error(bad_argument) once, with unknown_arguments()
void refuse_unknown_arguments(ScriptSession& session, bool is_over);

}  // namespace sterna::scripting
