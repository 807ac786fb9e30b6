// The kinds of objects that scripts hold: one table of their names, methods and fields, from which metatables, help(), the manual and completion are made.
#pragma once

#include <span>
#include <string_view>

#include "scripting/lua/script_call.h"
#include "scripting/lua/script_hooks.h"

namespace sterna::scripting {

std::span<const ObjectKind> object_kinds();
/// The kind of that name, or null.
const ObjectKind* object_kind(std::string_view name);
/// The kind of a value, or null where it is a number, a text, a table or a function.
const ObjectKind* kind_of(const ScriptValue& value);

}  // namespace sterna::scripting
