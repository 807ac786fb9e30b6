// Verbs of wind tunnels: the test section, and the assembly of models in it.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// The verbs test_section, assembly.
std::span<const ScriptVerb> tunnel_verbs();

}  // namespace sterna::scripting
