// All functions that may raise run inside lua_pcall, in frames that own no C++ object (see script_call.h).
#include "scripting/lua/script_function.h"

#include <lua.hpp>

#include "geom/base/error.h"
#include "scripting/cache/content_key.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {
namespace {

int keep(lua_State* state) {
  lua_pushinteger(state, luaL_ref(state, LUA_REGISTRYINDEX));
  return 1;
}

struct Exchange {
  int reference;
  const double* arguments;
  int n_arguments;
  double* results;
  int n_results;
};

int call_kept(lua_State* state) {
  const auto& exchange = *static_cast<const Exchange*>(lua_touserdata(state, 1));
  luaL_checkstack(state, exchange.n_arguments + exchange.n_results + 2, nullptr);
  lua_rawgeti(state, LUA_REGISTRYINDEX, exchange.reference);
  for (int i = 0; i < exchange.n_arguments; ++i) lua_pushnumber(state, exchange.arguments[i]);
  lua_call(state, exchange.n_arguments, exchange.n_results);
  for (int i = 0; i < exchange.n_results; ++i) {
    const int location = i - exchange.n_results;
    if (lua_type(state, location) != LUA_TNUMBER)
      return luaL_error(state, "a function must return %d numbers here, but value %d is %s", exchange.n_results, i + 1, luaL_typename(state, location));
    exchange.results[i] = lua_tonumber(state, location);
  }
  return 0;
}

struct ValueExchange {
  int reference;
  const ScriptValue* argument;
};

int call_kept_with_value(lua_State* state) {
  const auto& exchange = *static_cast<const ValueExchange*>(lua_touserdata(state, 1));
  lua_rawgeti(state, LUA_REGISTRYINDEX, exchange.reference);
  push_script_value(state, *exchange.argument);
  lua_call(state, 1, 1);
  return 1;
}

/// Removes the top value of the stack at the end of a scope.
struct PopAtEnd {
  lua_State* state;
  ~PopAtEnd() { lua_pop(state, 1); }
};

}  // namespace

ScriptFunction::ScriptFunction(lua_State* state, int index) : state_(state) {
  lua_pushvalue(state, index);
  lua_pushcfunction(state, keep);
  lua_insert(state, -2);
  if (lua_pcall(state, 1, 1, 0) != LUA_OK) {
    lua_pop(state, 1);
    throw Error({.code = ErrorCode::overflow, .attempted = "reading a function", .problem = "not enough memory"});
  }
  reference_ = static_cast<int>(lua_tointeger(state, -1));
  lua_pop(state, 1);
}

ScriptFunction::~ScriptFunction() { luaL_unref(state_, LUA_REGISTRYINDEX, reference_); }

void ScriptFunction::call(std::span<const double> arguments, std::span<double> results) const {
  Exchange exchange{reference_, arguments.data(), static_cast<int>(arguments.size()), results.data(), static_cast<int>(results.size())};
  lua_pushcfunction(state_, call_kept);
  lua_pushlightuserdata(state_, &exchange);
  if (lua_pcall(state_, 1, 0, 0) != LUA_OK) fail();
  if (session_of(state_).cache != nullptr) {
    answers_.insert(answers_.end(), arguments.begin(), arguments.end());
    answers_.insert(answers_.end(), results.begin(), results.end());
  }
}

ScriptValue ScriptFunction::call(const ScriptValue& argument) const {
  ValueExchange exchange{reference_, &argument};
  lua_pushcfunction(state_, call_kept_with_value);
  lua_pushlightuserdata(state_, &exchange);
  if (lua_pcall(state_, 1, 1, 0) != LUA_OK) fail();
  const PopAtEnd pop{state_};
  return script_value_at(state_, -1);
}

void ScriptFunction::fail() const {
  const Error error = error_on_top(state_);
  lua_pop(state_, 1);
  ErrorInfo info = error.info();
  if (info.attempted.empty()) info.attempted = k_calling_function;
  throw Error(std::move(info));
}

ContentKey ScriptFunction::key() const { return KeyMaker("function").add(answers_).key(); }

}  // namespace sterna::scripting
