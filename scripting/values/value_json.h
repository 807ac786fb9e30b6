// Plain values of a script - texts, numbers, true or false, tables of them - as JSON: what one process can tell another.
#pragma once

#include <string>
#include <string_view>

#include "scripting/lua/script_value.h"

namespace sterna::scripting {

/// Whether nothing of it is an object or a function. Meshes, surfaces and so on are not plain.
bool is_plain(const ScriptValue& value);
/// JSON of what a case's function gave: null of objects.
std::string to_result(const ScriptValue& value);

/// Compact JSON; keys in ascending order; numbers with all their digits. What is not plain is left out of tables, and null alone. Numbers that are not finite
/// are null. A table with unnamed entries is a list; one with both is an object whose entry "items" is the list.
std::string to_json(const ScriptValue& value);

/// null is nil, which tables do not hold.
/// \throws Error(file_malformed)
ScriptValue value_of_json(std::string_view text);

}  // namespace sterna::scripting
