// A Lua function that a script hands to a verb, callable from C++ while that verb runs.
#pragma once

#include <span>
#include <vector>

#include "scripting/cache/provenance.h"
#include "scripting/lua/script_value.h"

struct lua_State;

namespace sterna::scripting {

/// Lives as long as the call whose argument it is; only the thread that runs the script may call it.
/// What was attempted where an error of a function says nothing of it.
inline constexpr std::string_view k_calling_function = "calling a function of the script";

class ScriptFunction {
 public:
  /// Of the function at `index` of the stack, which stays as it is.
  /// \throws Error(overflow) without memory
  ScriptFunction(lua_State* state, int index);
  ~ScriptFunction();
  ScriptFunction(const ScriptFunction&) = delete;
  ScriptFunction& operator=(const ScriptFunction&) = delete;

  /// The first results.size() values that the function returns for these numbers.
  /// \throws Error(script_failed) with file:line where it fails or returns something else than numbers, Error(cancelled), or the Error of a verb that it calls
  void call(std::span<const double> arguments, std::span<double> results) const;
  /// What it returns for this value.
  /// \throws Error(script_failed) with file:line where it fails, Error(cancelled), or the Error of a verb that it calls
  ScriptValue call(const ScriptValue& argument) const;

  /// Of all arguments that it was called with through this object, and all that it returned.
  ContentKey key() const;

 private:
  [[noreturn]] void fail() const;
  lua_State* state_;
  int reference_;
  mutable std::vector<double> answers_;  ///< with their arguments; empty unless results are cached
};

}  // namespace sterna::scripting
