// A Lua value as C++ sees it: copied out before a verb starts, so that no verb ever touches the Lua stack.
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
/// A value that no verb takes (coroutine); known by its type's name only.
struct OpaqueValue {
  std::string_view type_name;
};
/// Of what a script that is only checked does not know: its type's name.
inline constexpr std::string_view k_unknown_value = "something that is not made when a script is only checked";

using ErrorHandle = std::shared_ptr<const Error>;
using ScriptValue =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::shared_ptr<const ScriptTable>, SurfaceHandle, EnvelopeHandle, TetrahedraHandle,
                 MeshHandle, ModelHandle, ComponentHandle, AirfoilHandle, ErrorHandle, FunctionHandle, QuantityHandle, const ScriptVerb*, OpaqueValue>;

struct ScriptTable {
  std::vector<ScriptValue> items;             ///< entries 1, 2, ... n
  std::map<std::string, ScriptValue> fields;  ///< named entries, by name: Lua's own order differs between runs
  std::vector<std::string> unknown_fields;    ///< names of entries whose values are not known (is_unknown); they are not among `fields`
  std::vector<std::string> other_keys;        ///< keys that are neither, e.g. "[true]"
};

/// Whether it is k_unknown_value.
bool is_unknown(const ScriptValue& value);

/// Whether both are the same object, not only equal ones.
bool is_same_object(const ScriptValue& a, const ScriptValue& b);

/// "a number", "a surface", "a table": the type for messages.
std::string_view type_text(const ScriptValue& value);
/// "surface" and so on of an object (script_objects.h); empty where it is a number, a text, a table or a function.
std::string_view object_name(const ScriptValue& value);

}  // namespace sterna::scripting
