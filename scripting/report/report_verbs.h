// Report pages in scripts: report{ mesh, "mesh.html" }.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> report_verbs();

}  // namespace sterna::scripting
