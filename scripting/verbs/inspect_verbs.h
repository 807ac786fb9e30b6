// The verb inspect{...}: what volume_mesh will make of a surface, before it is meshed.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> inspect_verbs();

/// What stands for the table of an inspection where a script is only checked: nothing was found.
ScriptValue inspection_stand_in();

}  // namespace sterna::scripting
