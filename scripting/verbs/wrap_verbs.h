// The verb wrap.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// The verb wrap. Takes surfaces and names of surface files.
std::span<const ScriptVerb> wrap_verbs();

}  // namespace sterna::scripting
