// Frames between Lua and its C functions own no C++ object (see script_call.h); functions that own one are marked noexcept and called from them.
#include "scripting/lua/script_sandbox.h"

#include <lua.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "geom/base/error.h"
#include "scripting/lua/script_call.h"
#include "scripting/lua/script_check.h"
#include "scripting/lua/script_hooks.h"
#include "scripting/lua/script_unknowns.h"
#include "scripting/lua/script_watch.h"

namespace sterna::scripting {
namespace {

/// Lua instructions between two checks of the stop token: about 0.1 ms.
constexpr int k_instructions_per_check = 10000;

// ---- Stop ----------------------------------------------------------------------------------------------------------------------------------

bool take_stop(ScriptSession& session) noexcept {
  if (!session.context.stop_token().stop_requested() && !session.series.is_case_over) return false;
  session.value = session.cancelled;
  return true;
}

void check_stop_hook(lua_State* state, lua_Debug* record) {
  if (record->event == LUA_HOOKRET) return note_locals(state, record);
  if (!take_stop(session_of(state))) return;
  // From this point every instruction stops, so that a pcall of the script cannot continue.
  lua_sethook(state, check_stop_hook, LUA_MASKCOUNT, 1);
  raise_failure(state);
}

// ---- print, require, math.randomseed -------------------------------------------------------------------------------------------------------

void print_text(ScriptSession& session, const char* text, std::size_t size) noexcept { session.print({text, size}); }

int print(lua_State* state) {
  luaL_Buffer buffer;
  const int n = lua_gettop(state);
  luaL_buffinit(state, &buffer);
  for (int i = 1; i <= n; ++i) {
    if (i > 1) luaL_addchar(&buffer, '\t');
    luaL_tolstring(state, i, nullptr);
    luaL_addvalue(&buffer);
  }
  luaL_pushresult(&buffer);
  std::size_t size = 0;
  const char* text = lua_tolstring(state, -1, &size);
  print_text(session_of(state), text, size);
  return 0;
}

/// Stores the module's source in session.value; returns false if it stored an error. \p where: "case.lua:5: "
bool read_module(ScriptSession& session, const char* name, const char* where) noexcept {
  try {
    const std::string module = name;
    if (module.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") != std::string::npos)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "require \"" + module + "\"",
                   .problem = "modules must be beside the script, with names of letters, digits, - and _"});
    const std::filesystem::path path = session.script.parent_path() / (module + ".lua");
    note_input(session.series, path);
    session.value = session.series.modules[module] = read_script(path);
    return true;
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = where + info.attempted;
    session.value = std::make_shared<const Error>(std::move(info));
    return false;
  }
}

int require(lua_State* state) {
  const char* name = luaL_checkstring(state, 1);
  lua_pushvalue(state, 1);
  if (lua_rawget(state, lua_upvalueindex(1)) != LUA_TNIL) return 1;
  lua_pop(state, 1);
  ScriptSession& session = session_of(state);
  luaL_where(state, 1);
  if (!read_module(session, name, lua_tostring(state, -1))) raise_failure(state);
  const char* chunk = lua_pushfstring(state, "@%s.lua", name);
  const auto* source = std::get_if<std::string>(&session.value);
  if (luaL_loadbufferx(state, source->data(), source->size(), chunk, "t") != LUA_OK) return lua_error(state);
  lua_call(state, 0, 1);
  if (lua_isnil(state, -1)) {
    lua_pop(state, 1);
    lua_pushboolean(state, 1);
  }
  lua_pushvalue(state, 1);
  lua_pushvalue(state, -2);
  lua_rawset(state, lua_upvalueindex(1));
  return 1;
}

/// Replaces math.randomseed. Without a number Lua would take a seed from the clock; here the run's own sequence is restarted.
int random_seed(lua_State* state) {
  const int n = lua_gettop(state);
  lua_pushvalue(state, lua_upvalueindex(1));
  if (n == 0) lua_pushinteger(state, static_cast<lua_Integer>(session_of(state).context.seed()));
  for (int i = 1; i <= n; ++i) lua_pushvalue(state, i);
  lua_call(state, n == 0 ? 1 : n, 0);
  return 0;
}

/// Replaces pairs(). Lua seeds the order of its tables from addresses and the clock, so two runs of one script could differ. Here pairs() iterates over
/// numbers, then strings, in ascending order; keys of other types come last, in Lua's order. Entries that are removed during the iteration are skipped.
constexpr std::string_view k_ordered_pairs = R"lua(
local next, type, rawget, sort, getmetatable, unordered = next, type, rawget, table.sort, getmetatable, pairs
local rank = { number = 1, string = 2 }
local function before(a, b)
  local rank_a, rank_b = rank[type(a)], rank[type(b)]
  if rank_a ~= rank_b then return rank_a < rank_b end
  return a < b
end
function pairs(...)
  local t = ...
  local meta = getmetatable(t)
  if type(t) ~= "table" or type(meta) == "table" and rawget(meta, "__pairs") then return unordered(...) end
  local keys, n, others = {}, 0, {}
  for key in next, t do
    if rank[type(key)] then
      n = n + 1
      keys[n] = key
    else
      others[#others + 1] = key
    end
  end
  sort(keys, before)
  for i = 1, #others do keys[n + i] = others[i] end
  local i = 0
  return function()
    while true do
      i = i + 1
      local key = keys[i]
      if key == nil then return nil end
      local value = rawget(t, key)
      if value ~= nil then return key, value end
    end
  end, t, nil
end
)lua";

// ---- The sandbox ---------------------------------------------------------------------------------------------------------------------------

/// Calls Lua's own pcall or xpcall (upvalue 1). A stop that they catch is raised again.
int protected_call(lua_State* state) {
  const int n = lua_gettop(state);
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, n, LUA_MULTRET);
  if (take_stop(session_of(state))) raise_failure(state);
  return lua_gettop(state);
}

/// Calls the script's message handler (upvalue 1), except for a stop, because the handler would run where no hook is called and could run endlessly.
int handle_message(lua_State* state) {
  if (take_stop(session_of(state))) return 1;
  lua_settop(state, 1);
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, 1, 1);
  return 1;
}

int protected_call_with_handler(lua_State* state) {
  luaL_checkany(state, 2);
  lua_pushvalue(state, 2);
  lua_pushcclosure(state, handle_message, 1);
  lua_replace(state, 2);
  return protected_call(state);
}

/// Replaces setmetatable to reject __gc: Lua runs it where no hook is called, and a loop there could not be stopped.
int set_metatable(lua_State* state) {
  if (lua_type(state, 2) == LUA_TTABLE) {
    lua_pushliteral(state, "__gc");
    if (lua_rawget(state, 2) != LUA_TNIL) return luaL_error(state, "__gc is not available in scripts");
    lua_pop(state, 1);
  }
  const int n = lua_gettop(state);
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, n, 1);
  return 1;
}

/// Replaces the global function `name` by `ours`, which receives the original as its upvalue.
void wrap_global(lua_State* state, const char* name, lua_CFunction ours) {
  lua_getglobal(state, name);
  lua_pushcclosure(state, ours, 1);
  lua_setglobal(state, name);
}

}  // namespace

std::string read_script(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw Error({.code = ErrorCode::file_not_found, .attempted = "reading " + path.string(), .problem = "the script cannot be opened"});
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string where_of(lua_State* state) {
  lua_Debug record;
  for (int level = 1; lua_getstack(state, level, &record); ++level) {
    lua_getinfo(state, "Sl", &record);
    if (record.currentline <= 0) continue;
    const std::string_view source = record.source;
    return std::string(source.starts_with('@') ? source.substr(1) : std::string_view(record.short_src)) + ":" + std::to_string(record.currentline) + ": ";
  }
  return {};
}

bool is_protected(lua_State* state) {
  lua_Debug record;
  for (int level = 1; lua_getstack(state, level, &record); ++level) {
    lua_getinfo(state, "f", &record);
    const lua_CFunction function = lua_tocfunction(state, -1);
    lua_pop(state, 1);
    if (function == protected_call || function == protected_call_with_handler) return true;
  }
  return false;
}

void open_sandbox(lua_State* state) {
  luaL_requiref(state, LUA_GNAME, luaopen_base, 1);
  luaL_requiref(state, LUA_TABLIBNAME, luaopen_table, 1);
  luaL_requiref(state, LUA_STRLIBNAME, luaopen_string, 1);
  luaL_requiref(state, LUA_MATHLIBNAME, luaopen_math, 1);
  luaL_requiref(state, LUA_UTF8LIBNAME, luaopen_utf8, 1);
  lua_settop(state, 0);
  for (const char* forbidden : {"dofile", "loadfile", "load"}) {
    lua_pushnil(state);
    lua_setglobal(state, forbidden);
  }
  wrap_global(state, "pcall", protected_call);
  wrap_global(state, "xpcall", protected_call_with_handler);
  wrap_global(state, "setmetatable", set_metatable);
  lua_pushcfunction(state, print);
  lua_setglobal(state, "print");
  lua_newtable(state);
  lua_pushcclosure(state, require, 1);
  lua_setglobal(state, "require");
  lua_getglobal(state, LUA_MATHLIBNAME);
  lua_getfield(state, -1, "randomseed");
  lua_pushcclosure(state, random_seed, 1);
  lua_pushvalue(state, -1);
  lua_setfield(state, -3, "randomseed");
  lua_call(state, 0, 0);
  if (luaL_loadbufferx(state, k_ordered_pairs.data(), k_ordered_pairs.size(), "=pairs", "t") != LUA_OK) lua_error(state);
  lua_call(state, 0, 0);
  lua_settop(state, 0);
}

namespace {

/// Notes the problem for a script that is only checked. The script continues with an unknown value.
bool note_unknown_name(lua_State* state, const char* name) noexcept {
  ScriptSession& session = session_of(state);
  if (!session.check || is_protected(state)) return false;
  try {
    ErrorInfo info{.code = ErrorCode::script_failed, .attempted = {}, .problem = where_of(state) + "unknown name (global '" + name + "')"};
    info.hint = session.hooks->hint_for_global(name);
    session.check->problems.push_back(std::make_shared<const Error>(std::move(info)));
    return true;
  } catch (const std::exception&) {
    return false;  // if memory is exhausted, Lua's own message is used
  }
}

/// Reports an undefined name. In Lua it would be nil, and a table drops nil: unit = parsec would silently set no unit at all.
int unknown_global(lua_State* state) {
  if (lua_type(state, 2) != LUA_TSTRING) return 0;
  const char* name = lua_tostring(state, 2);
  if (!note_unknown_name(state, name)) return luaL_error(state, "unknown name (global '%s')", name);
  push_unknown(state);
  lua_pushvalue(state, 2);
  lua_pushvalue(state, -2);
  lua_rawset(state, 1);  // reported once
  return 1;
}

}  // namespace

void refuse_unknown_globals(lua_State* state) {
  lua_pushglobaltable(state);
  lua_newtable(state);
  lua_pushcfunction(state, unknown_global);
  lua_setfield(state, -2, "__index");
  lua_setmetatable(state, -2);
  lua_pop(state, 1);
}

void watch_for_stop(lua_State* state) {
  const int returns = session_of(state).watch ? LUA_MASKRET : 0;
  lua_sethook(state, check_stop_hook, LUA_MASKCOUNT | returns, k_instructions_per_check);
}

}  // namespace sterna::scripting
