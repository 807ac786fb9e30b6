// args: the values that `sterna run case.lua alpha=4 half=true` passes to a script.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// The verb args.
std::span<const ScriptVerb> argument_verbs();
/// The verb args itself, which is also a table: args.alpha.
const ScriptVerb& arguments_verb();
extern const ScriptVerb k_argument_field;

/// Splits "alpha=4" into name and value.
/// \throws Error(bad_argument) if the string is not NAME=VALUE
std::pair<std::string, std::string> split_argument(const std::string& text);

}  // namespace sterna::scripting
