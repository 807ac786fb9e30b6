// A Lua state with the sandbox, the verbs and a session; runs pieces of Lua, one after the other.
#pragma once

#include <memory>
#include <string>

#include "scripting/interpreter/script_run.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

class ScriptState {
 public:
  /// \throws Error unknown_option or bad_argument of an override; overflow without memory.
  ScriptState(const ScriptSettings& settings, const RunContext& context);
  ~ScriptState();
  ScriptState(const ScriptState&) = delete;
  ScriptState& operator=(const ScriptState&) = delete;

  /// Runs a chunk of Lua that messages call `name`. The traceback of an error that comes out of functions of the script is in its text.
  /// \throws Error as run_script
  void run(const std::string& text, const std::string& name);
  /// The same; prints what the chunk returns, as an interactive prompt does.
  void run_and_print(const std::string& text, const std::string& name);
  /// Whether the text is the beginning of something longer, as far as Lua can tell.
  bool is_incomplete(const std::string& text);

  /// Whether Lua can read the text.
  bool is_correct(const std::string& text);

  ScriptSession& session();
  lua_State* lua();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sterna::scripting
