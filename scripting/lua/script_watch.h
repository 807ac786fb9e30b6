// Who looks on while a script runs: what it makes, what it calls that, which arguments it takes. The workbench (scripting/view) does.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/script_parameter.h"

struct lua_State;
struct lua_Debug;

namespace sterna::scripting {

struct ScriptWatch {
  std::function<void(const ScriptCall& call, const ScriptValue& value)> made;  ///< behind each verb that gave an object
  /// When a function of the script, or the script itself, ends: a local variable that holds an object, or a table that holds some ("wings.left").
  std::function<void(std::string_view name, bool is_of_script, const ScriptValue& value)> named;
  /// All arguments so far, in the order of their declaration; is_complete: no later args{} can add to them.
  std::function<void(const std::vector<ScriptParameter>&, bool is_complete)> declared;
  bool is_sketch = false;             ///< solids that would be united stay side by side: to see at once where things are
  mutable bool has_left_out = false;  ///< a sketch did
};

/// Of a verb that unites: whether it does not this time (ScriptWatch::is_sketch), which is noted.
bool is_sketch(const ScriptCall& call);

/// Tells the watch of the objects in the local variables of a function that is about to end. \pre the state's session has a watch
void note_locals(lua_State* state, lua_Debug* record) noexcept;
/// The same of all functions that are running: where an error ended them.
void note_all_locals(lua_State* state) noexcept;

}  // namespace sterna::scripting
