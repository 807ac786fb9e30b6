// Plain values of a script (strings, numbers, true or false, and tables of them) as JSON. These are the values that one process can pass to another.
#pragma once

#include <string>
#include <string_view>

#include "scripting/lua/script_value.h"

namespace sterna::scripting {

/// Returns true if the value contains no object and no function. Meshes, surfaces and so on are not plain.
bool is_plain(const ScriptValue& value);
/// Returns the JSON of the result of a case's function: null for objects.
std::string to_result(const ScriptValue& value);

/// Returns compact JSON with keys in ascending order and numbers with all their digits. Values that are not plain are omitted from tables; a single one becomes
/// null. Numbers that are not finite are null. A table with unnamed entries is a list. A table with both named and unnamed entries is an object whose entry
/// "items" is the list.
std::string to_json(const ScriptValue& value);

/// Parses JSON. null becomes nil, which tables do not hold.
/// \throws Error(file_malformed)
ScriptValue value_of_json(std::string_view text);

}  // namespace sterna::scripting
