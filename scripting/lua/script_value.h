// A Lua value in C++: copied before a verb starts, so that no verb ever accesses the Lua stack.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geom/base/error.h"
#include "scripting/lua/handles.h"

namespace sterna::scripting {

struct ScriptTable;
struct ScriptVerb;  // script_call.h
/// A value that no verb accepts (coroutine); only the name of its type is known.
struct OpaqueValue {
  std::string_view type_name;
};
/// Type name of an unknown value in a script that is only checked.
inline constexpr std::string_view k_unknown_value = "an object that does not exist while a script is checked";

using ErrorHandle = std::shared_ptr<const Error>;
using ScriptValue =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::shared_ptr<const ScriptTable>, SurfaceHandle, EnvelopeHandle, TetrahedraHandle,
                 MeshHandle, ModelHandle, ComponentHandle, AirfoilHandle, ErrorHandle, FunctionHandle, QuantityHandle, const ScriptVerb*, OpaqueValue>;

struct ScriptTable {
  std::vector<ScriptValue> items;             ///< entries 1, 2, ... n
  std::map<std::string, ScriptValue> fields;  ///< named entries, sorted by name, because Lua's own order differs between runs
  std::vector<std::string> unknown_fields;    ///< names of entries with unknown values (is_unknown); they are not among `fields`
  std::vector<std::string> other_keys;        ///< keys of other types, e.g. "[true]"
};

/// Returns true if the value is k_unknown_value.
bool is_unknown(const ScriptValue& value);

/// Returns true if both are the same object, not only equal objects.
bool is_same_object(const ScriptValue& a, const ScriptValue& b);

/// Returns "a number", "a surface", "a table": the type for messages.
std::string_view type_text(const ScriptValue& value);
/// Returns "surface" and so on for an object (script_objects.h); empty for a number, a string, a table or a function.
std::string_view object_name(const ScriptValue& value);

}  // namespace sterna::scripting
