// The verb inspect{...}: what volume_mesh will make of a surface, before it is meshed.
#pragma once

#include <span>

#include "scripting/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> inspect_verbs();

}  // namespace sterna::scripting
