// The envelope step by step: envelope.classify, .initial, .smooth, .untangle, .unwarp, .retract, .optimise.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> envelope_step_verbs();

/// \throws Error(bad_argument) with the places, and the steps that are missing, where an envelope is not valid and clear yet. Nothing to do for a finished one,
/// which is proved later.
void require_ready(const EnvelopeValue& envelope, const volmesh::MeshCase& options, const RunContext& context);

}  // namespace sterna::scripting
