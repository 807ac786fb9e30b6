// Verbs for the envelope step by step: envelope.classify, .initial, .smooth, .untangle, .unwarp, .retract, .optimise.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> envelope_step_verbs();

}  // namespace sterna::scripting
