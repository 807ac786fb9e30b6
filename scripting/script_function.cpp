// Everything that may raise runs inside lua_pcall, in frames that own no C++ object (see script_call.h).
#include "scripting/script_function.h"

#include <lua.hpp>

#include "geom/base/error.h"
#include "scripting/script_call.h"

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
    const int place = i - exchange.n_results;
    if (lua_type(state, place) != LUA_TNUMBER)
      return luaL_error(state, "a function must return %d numbers here, but value %d is %s", exchange.n_results, i + 1, luaL_typename(state, place));
    exchange.results[i] = lua_tonumber(state, place);
  }
  return 0;
}

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
  if (lua_pcall(state_, 1, 0, 0) == LUA_OK) return;
  const Error error = error_on_top(state_);
  lua_pop(state_, 1);
  ErrorInfo info = error.info();
  if (info.attempted.empty()) info.attempted = "calling a function of the script";
  throw Error(std::move(info));
}

}  // namespace sterna::scripting
