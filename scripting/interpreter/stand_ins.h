// What stands for results where a script is only checked.
#pragma once

#include <string_view>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// As stand_in() of script_check.h: made when first asked for, and kept in the session's check.
/// \pre the run only checks
ScriptValue make_stand_in(const ScriptCall& call, std::string_view gives);

}  // namespace sterna::scripting
