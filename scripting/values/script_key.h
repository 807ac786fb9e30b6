// What a verb of a script was called with, as a key: of models, whose exact geometry has no bytes of its own that could be compared.
#pragma once

#include <optional>

#include "scripting/cache/provenance.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// The verb and its arguments after it has run: numbers and texts as they are, files by their names and contents, tables by their entries, objects by their own
/// keys, functions by what they were asked and what they returned. Options of the command line count where they may be of models. Nothing where an argument has
/// no key.
std::optional<ContentKey> key_of_call(const ScriptCall& call);

/// The result of a verb; one that is a new model knows what it was made of from now on.
ScriptValue with_provenance(ScriptValue result, const ScriptCall& call);

}  // namespace sterna::scripting
