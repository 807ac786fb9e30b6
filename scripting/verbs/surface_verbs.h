// The verb that makes a triangulation of models: surface_mesh.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> surface_verbs();

}  // namespace sterna::scripting
