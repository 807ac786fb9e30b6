// The verbs that make a volume mesh step by step (make_envelope, tetrahedra, prisms, read_stages), and their objects.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> stage_verbs();
std::span<const ScriptVerb> envelope_methods();
std::span<const ScriptVerb> tetrahedra_methods();

/// Verbs that read object.name for names that are no method.
extern const ScriptVerb k_envelope_field;
extern const ScriptVerb k_tetrahedra_field;

}  // namespace sterna::scripting
