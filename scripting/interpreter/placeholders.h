// Placeholders for results when a script is only checked.
#pragma once

#include <string_view>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// Makes the result of placeholder() (script_check.h). It is created on first use, and kept in the session's check.
/// \pre the run only checks
ScriptValue make_placeholder(const ScriptCall& call, std::string_view gives);

}  // namespace sterna::scripting
