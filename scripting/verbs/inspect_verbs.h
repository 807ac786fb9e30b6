// The verb inspect{...}: the expected result of volume_mesh for a surface, before meshing.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> inspect_verbs();

/// Returns a placeholder for the table of an inspection, without findings, for a script that is only checked.
ScriptValue inspection_placeholder();

}  // namespace sterna::scripting
