// The arguments of a script and its modules together; each of them may call args{}.
#pragma once

#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/script_parameter.h"

namespace sterna::scripting {

/// Adds the arguments declared by the args{} at `where` ("case.lua:5: "), in the order of the source. An argument may be declared several times in the same
/// way. \return problems: names that were declared before with another default or other limits
std::vector<std::string> add_declared(ScriptSession& session, const std::string& where, std::vector<ScriptParameter> parameters);

/// Returns a problem for each argument of the command line that no args{} has declared. Returns none before the first args{}. While the script runs, also
/// returns none if a module that is not loaded yet, or an args{} that has not run yet, may still declare the argument.
std::vector<std::string> unknown_arguments(const ScriptSession& session, bool is_over);

/// Checks the arguments. To be called before work that takes time and when the script is over.
/// \throws Error(bad_argument) once, with unknown_arguments()
void refuse_unknown_arguments(ScriptSession& session, bool is_over);

}  // namespace sterna::scripting
