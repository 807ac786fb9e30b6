// Observer of a running script: the objects it makes, their names, the arguments it takes. Used by the workbench (scripting/view).
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
  std::function<void(const ScriptCall& call, const ScriptValue& value)> made;  ///< called after each verb that returned an object
  /// Called when a function of the script, or the script itself, ends. It receives each local variable that holds an object, or a table that holds objects
  /// ("wings.left").
  std::function<void(std::string_view name, bool is_of_script, const ScriptValue& value)> named;
  /// Receives all arguments so far, in the order of their declaration. is_complete: no later args{} can add arguments.
  std::function<void(const std::vector<ScriptParameter>&, bool is_complete)> declared;
  bool is_sketch = false;             ///< solids that would be united stay side by side, for a quick view of their positions
  mutable bool has_left_out = false;  ///< a union was skipped for a sketch
};

/// Returns true if a verb that unites must skip the union (ScriptWatch::is_sketch); the skip is noted.
bool is_sketch(const ScriptCall& call);

/// Reports to the watch the objects in the local variables of a function that is about to end. \pre the state's session has a watch
void note_locals(lua_State* state, lua_Debug* record) noexcept;
/// Reports the objects of all running functions, after an error ended them.
void note_all_locals(lua_State* state) noexcept;

}  // namespace sterna::scripting
