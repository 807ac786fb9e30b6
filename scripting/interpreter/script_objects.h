// The kinds of objects in scripts. One table has their names, methods and fields; metatables, help(), the manual and completion are generated from it.
#pragma once

#include <span>
#include <string_view>

#include "scripting/lua/script_call.h"
#include "scripting/lua/script_hooks.h"

namespace sterna::scripting {

std::span<const ObjectKind> object_kinds();
/// Returns the kind of that name, or null.
const ObjectKind* object_kind(std::string_view name);
/// Returns the kind of a value, or null for a number, a string, a table or a function.
const ObjectKind* kind_of(const ScriptValue& value);

}  // namespace sterna::scripting
