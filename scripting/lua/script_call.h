// The bridge between Lua's C API and C++ verbs. Lua raises errors with longjmp, C++ with exceptions, and neither may cross the other's frames:
//   1. call_verb (no object with a destructor in its frame) calls run_verb, which is noexcept;
//   2. run_verb copies the arguments out with Lua functions that never raise, runs the verb, and leaves its value or its Error in the session;
//   3. back in call_verb, every C++ object of the call is destroyed: then the value is pushed, or the error raised.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/base/run_context.h"
#include "scripting/cache/reuse.h"
#include "scripting/lua/held_options.h"
#include "scripting/lua/script_parameter.h"
#include "scripting/lua/script_value.h"
#include "scripting/lua/series_session.h"

struct lua_State;

namespace sterna::scripting {

using OptionOverrides = std::vector<std::pair<std::string, std::string>>;  ///< "stage.option", "value"

struct ScriptCheck;  // script_check.h
struct ScriptHooks;  // script_hooks.h
struct ScriptWatch;  // script_watch.h

/// State shared by a running script and its verbs.
struct ScriptSession {
  RunContext context;
  std::filesystem::path script;                   ///< its folder is the second search location of input files
  OptionOverrides overrides;                      ///< options of the command line; they win over the script
  std::function<void(std::string_view)> print;    ///< receives results
  std::function<void(const MeshValue&)> on_mesh;  ///< called for every volume mesh made; may be empty
  const StageCache* cache = nullptr;              ///< results of stages by the content of their inputs; null if everything is recomputed
  std::vector<std::string> reused = {};           ///< a line for each stage that was taken from the cache or started from a reference: "surface_mesh of body"
  ErrorHandle cancelled;                          ///< allocated in advance, because the hook that raises it must not allocate
  OptionOverrides arguments = {};                 ///< NAME=VALUE of the command line, for args
  ScriptCheck* check = nullptr;                   ///< not null: nothing is meshed or written (script_check.h)

  std::filesystem::path input_folder = {};   ///< see ScriptSettings
  std::filesystem::path output_folder = {};  ///< relative output names go there; empty = current folder
  SeriesSession series = {};

  const ScriptHooks* hooks = nullptr;  ///< never null while a script runs
  const ScriptWatch* watch = nullptr;  ///< observer; null: none

  ScriptValue value;  ///< result or error of a verb, for call_verb

  DeclaredArguments declared = {};  ///< arguments of all args{} that have run

  Reuse reuse() { return {cache, &reused, series.reference ? series.reference->use.get() : nullptr}; }
};

/// "case.lua:5: volume_mesh", the start of a message. The reader of the verb's table finds here if the verb ends after all checks.
struct Attempt : std::string {
  Attempt(std::string text, ScriptCheck* of_check, bool ends) : std::string(std::move(text)), check(of_check), ends_with_checks(ends) {}
  ScriptCheck* check;
  bool ends_with_checks;
};

/// One call of a verb.
struct ScriptCall {
  ScriptSession& session;
  std::string where;                   ///< location of the call, "case.lua:5: ", or empty
  std::string_view verb;               ///< "volume_mesh"
  std::vector<ScriptValue> arguments;  ///< for a method: the object first
  bool is_heavy = false;               ///< ScriptVerb::is_heavy, except if the run only checks but makes this geometry (ScriptCheck::makes_geometry)
  bool is_geometry = false;            ///< the verb is heavy but executed, because the run checks and makes this geometry

  Attempt attempted() const { return {where + std::string(verb), session.check, session.check != nullptr && is_heavy}; }
};

struct ScriptVerb {
  std::string_view name;     ///< "volume_mesh"; for a method "mesh:check"; "envelope.smooth" is a function of the table envelope
  std::string_view usage;    ///< one line of Lua
  std::string_view summary;  ///< one sentence
  ScriptValue (*run)(const ScriptCall&);
  std::string (*options_help)() = nullptr;
  bool is_heavy = false;  ///< takes long or writes files: left out when a script is only checked. Before the call, meshes that are no longer used are freed,
                          ///< because Lua does not know how large they are
  std::string_view gives = {};         ///< kind of object (script_objects.h), "self", "model or surface", "stages", "table"; empty: other
  bool is_kept = false;                ///< the model that it returns is taken from the cache if present (values/cached_model.h)
  HeldOptions (*options)() = nullptr;  ///< options that a command for this verb has as well; without options_help they are the help
};

/// Returns the help on the options of a verb; empty if it has none.
std::string help_on_options(const ScriptVerb& verb);

/// Pushes a verb as a Lua function. May raise.
void push_verb(lua_State* state, const ScriptVerb& verb);
/// Pushes a table that can be called as `verb`, with fields that are read by `field`. May raise.
void push_verb_table(lua_State* state, const ScriptVerb& verb, const ScriptVerb& field);
/// Makes the metatables of all kinds of objects (script_objects.h), with their methods. May raise.
void register_objects(lua_State* state);
/// Returns the session of a state that was made by run_script.
ScriptSession& session_of(lua_State* state) noexcept;
void set_session(lua_State* state, ScriptSession& session) noexcept;
/// Pass values to and from functions of scripts that are called from C++. The first function pushes a value and may raise; the second copies a value out and
/// never raises.
/// \throws Error(bad_argument) for tables nested too deep
void push_script_value(lua_State* state, const ScriptValue& value);
ScriptValue script_value_at(lua_State* state, int index);
/// Raises the error in session.value as a Lua error. Never returns.
[[noreturn]] void raise_failure(lua_State* state);
/// Returns the Error of the error value on top of the stack, if a verb raised it; else a script_failed with Lua's message.
Error error_on_top(lua_State* state);

}  // namespace sterna::scripting
