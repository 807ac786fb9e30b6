// A Lua state with the sandbox, the verbs and a session. It runs chunks of Lua, one after the other.
#pragma once

#include <memory>
#include <string>

#include "scripting/interpreter/script_run.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// The functions of the interpreter for the sessions of scripts and commands.
const ScriptHooks& script_hooks();

class ScriptState {
 public:
  /// \throws Error unknown_option or bad_argument of an override; overflow without memory.
  ScriptState(const ScriptSettings& settings, const RunContext& context);
  ~ScriptState();
  ScriptState(const ScriptState&) = delete;
  ScriptState& operator=(const ScriptState&) = delete;

  /// Runs a chunk of Lua, called `name` in messages. If an error comes from functions of the script, its text contains the traceback.
  /// \throws Error as run_script
  void run(const std::string& text, const std::string& name);
  /// Runs a chunk and prints its results, as an interactive prompt does.
  void run_and_print(const std::string& text, const std::string& name);
  /// Returns true if the text is the beginning of a longer statement, as far as Lua can detect this.
  bool is_incomplete(const std::string& text);

  /// Returns true if Lua can parse the text.
  bool is_correct(const std::string& text);

  ScriptSession& session();
  lua_State* lua();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sterna::scripting
