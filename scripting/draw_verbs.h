// Pictures in scripts: draw{ mesh, "mesh.png", view = "iso" }.
#pragma once

#include <span>

#include "scripting/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> draw_verbs();

}  // namespace sterna::scripting
