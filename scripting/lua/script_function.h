// A Lua function that a script passes to a verb, callable from C++ while that verb runs.
#pragma once

#include <span>
#include <vector>

#include "scripting/cache/provenance.h"
#include "scripting/lua/script_value.h"

struct lua_State;

namespace sterna::scripting {

/// Attempted action for an error of a function that names none.
inline constexpr std::string_view k_calling_function = "calling a function of the script";

/// Reference to a Lua function. Lives as long as the call whose argument it is; only the thread that runs the script may call it.
class ScriptFunction {
 public:
  /// Refers to the function at `index` of the stack; the stack is unchanged.
  /// \throws Error(overflow) without memory
  ScriptFunction(lua_State* state, int index);
  ~ScriptFunction();
  ScriptFunction(const ScriptFunction&) = delete;
  ScriptFunction& operator=(const ScriptFunction&) = delete;

  /// Calls the function with these numbers and takes its first results.size() values.
  /// \throws Error(script_failed) with file:line if it fails or returns values that are no numbers, Error(cancelled), or the Error of a verb that it calls
  void call(std::span<const double> arguments, std::span<double> results) const;
  /// Returns the result of the function for this value.
  /// \throws Error(script_failed) with file:line if it fails, Error(cancelled), or the Error of a verb that it calls
  ScriptValue call(const ScriptValue& argument) const;

  /// Returns the key of all arguments and results of calls through this object.
  ContentKey key() const;

 private:
  [[noreturn]] void fail() const;
  lua_State* state_;
  int reference_;
  mutable std::vector<double> answers_;  ///< results with their arguments; empty unless results are cached
};

}  // namespace sterna::scripting
