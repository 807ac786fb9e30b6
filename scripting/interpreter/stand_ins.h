// Placeholders for results when a script is only checked.
#pragma once

#include <string_view>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// As stand_in() of script_check.h: created on first use, and kept in the session's check.
/// \pre the run only checks
ScriptValue make_stand_in(const ScriptCall& call, std::string_view gives);

}  // namespace sterna::scripting
