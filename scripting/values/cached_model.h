// Models of verbs that read or unite them, taken from a cache where they are there.
#pragma once

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// What the verb gives, or, of a verb whose models are kept, the model that the same call gave before: same arguments by content, same names of inputs. Its
/// shape for OpenCASCADE is not kept: whoever needs it has the verb run again then, which is seldom. Calls with functions, and models of deformed or foreign
/// surfaces, are made anew.
/// \throws what the verb throws
ScriptValue cached_model(const ScriptVerb& verb, const ScriptCall& call);

}  // namespace sterna::scripting
