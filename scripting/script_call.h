// The bridge between Lua's C API and C++ verbs. Lua raises errors with longjmp, C++ with exceptions, and neither may cross the other's frames:
//   1. call_verb (no object with a destructor in its frame) calls run_verb, which is noexcept;
//   2. run_verb copies the arguments out with Lua functions that never raise, runs the verb, and leaves its value or its Error in the session;
//   3. back in call_verb, every C++ object of the call is gone: now the value is pushed, or the error raised.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/base/run_context.h"
#include "scripting/script_value.h"

struct lua_State;

namespace sterna::scripting {

using OptionOverrides = std::vector<std::pair<std::string, std::string>>;  ///< "stage.option", "value"

/// Everything a running script shares with its verbs.
struct ScriptSession {
  RunContext context;
  std::filesystem::path script;                    ///< its folder is where input files are looked for second
  OptionOverrides overrides;                       ///< of the command line; they win over the script
  std::function<void(std::string_view)> print;     ///< results
  std::function<void(const MeshValue&)> on_mesh;   ///< called for every volume mesh made; may be empty
  ErrorHandle cancelled;                           ///< prepared, because the hook that raises it must not allocate

  ScriptValue value;  ///< what a verb leaves for call_verb: its result or its error
};

/// One call of a verb.
struct ScriptCall {
  ScriptSession& session;
  std::string where;                    ///< "case.lua:5: ", or empty
  std::string_view verb;                ///< "volume_mesh"
  std::vector<ScriptValue> arguments;   ///< of a method: the object first

  /// "case.lua:5: volume_mesh", the start of a message.
  std::string attempted() const { return where + std::string(verb); }
};

struct ScriptVerb {
  std::string_view name;     ///< "volume_mesh"; of a method "mesh:check"
  std::string_view usage;    ///< one line of Lua
  std::string_view summary;  ///< one sentence
  ScriptValue (*run)(const ScriptCall&);
  std::string (*options_help)() = nullptr;
  bool is_heavy = false;     ///< dead meshes are collected first: Lua does not see how large they are
};

/// Pushes a verb as a Lua function. May raise.
void push_verb(lua_State* state, const ScriptVerb& verb);
/// Makes the metatables of surfaces, meshes and errors, with their methods. May raise.
void register_objects(lua_State* state);
/// The session of a state that was made by run_script.
ScriptSession& session_of(lua_State* state) noexcept;
void set_session(lua_State* state, ScriptSession& session) noexcept;
/// Raises the error in session.value as a Lua error. Never returns.
[[noreturn]] void raise_failure(lua_State* state);
/// The Error of the error value on top of the stack, if a verb raised it; else a script_failed with Lua's message.
Error error_on_top(lua_State* state);

}  // namespace sterna::scripting
