// Takes models of verbs that read or unite models from a cache if present.
#pragma once

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// Returns the result of the verb. For verbs whose models are cached, this may be the model of an earlier identical call: arguments have the same content,
/// inputs have the same names. The OpenCASCADE shape of the model is not cached: code that needs the shape runs the verb again, which is rare. Calls with
/// functions, and models of deformed or foreign surfaces, are always recomputed.
/// \throws what the verb throws
ScriptValue cached_model(const ScriptVerb& verb, const ScriptCall& call);

}  // namespace sterna::scripting
