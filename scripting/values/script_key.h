// Keys of verb calls in scripts. They are used for models, whose exact geometry has no bytes of its own that could be compared.
#pragma once

#include <optional>

#include "scripting/cache/provenance.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// Returns the key of the verb and its arguments after the verb has run. Numbers and strings enter the key as they are, files by their names and contents,
/// tables by their entries, objects by their own keys, functions by their arguments and results. Options of the command line are included if they may apply to
/// models. Returns nothing if an argument has no key.
std::optional<ContentKey> key_of_call(const ScriptCall& call);

/// Returns the result of a verb; a result that is a new model gets the key of its inputs.
ScriptValue with_provenance(ScriptValue result, const ScriptCall& call);

}  // namespace sterna::scripting
