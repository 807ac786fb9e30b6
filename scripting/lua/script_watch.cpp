#include "scripting/lua/script_watch.h"

#include <lua.hpp>

#include <cstring>

namespace sterna::scripting {
namespace {

/// Maximum number of entries inspected in a table; longer tables are lists of numbers.
constexpr int k_most_entries = 200;
/// Depth of the stack up to which functions are inspected after an error: an endless recursion is deeper.
constexpr int k_most_levels = 50;

void report_object(lua_State* state, const std::string& name, bool is_of_script, int index) {
  const ScriptValue value = script_value_at(state, index);
  if (!object_name(value).empty()) session_of(state).watch->named(name, is_of_script, value);
}

/// Reports the value of a local variable, which is on top of the stack.
void look_at_local(lua_State* state, const std::string& name, bool is_of_script) {
  const int top = lua_gettop(state);
  if (lua_type(state, top) == LUA_TUSERDATA) return report_object(state, name, is_of_script, top);
  if (!is_of_script || lua_type(state, top) != LUA_TTABLE || !lua_checkstack(state, 4)) return;
  lua_pushnil(state);
  for (int n = 0; n < k_most_entries && lua_next(state, top) != 0; ++n) {
    if (lua_type(state, -1) == LUA_TUSERDATA) {
      if (lua_type(state, -2) == LUA_TSTRING) report_object(state, name + "." + lua_tostring(state, -2), is_of_script, lua_gettop(state));
      else if (lua_isinteger(state, -2)) report_object(state, name + "[" + std::to_string(lua_tointeger(state, -2)) + "]", is_of_script, lua_gettop(state));
    }
    lua_pop(state, 1);
  }
  lua_settop(state, top);
}

}  // namespace

bool is_sketch(const ScriptCall& call) {
  if (!call.session.watch || !call.session.watch->is_sketch) return false;
  call.session.watch->has_left_out = true;
  return true;
}

void note_locals(lua_State* state, lua_Debug* record) noexcept {
  const int top = lua_gettop(state);
  try {
    if (!lua_checkstack(state, 8) || lua_getinfo(state, "S", record) == 0 || record->source[0] != '@') return;
    const bool is_of_script = std::strcmp(record->what, "main") == 0;
    for (int i = 1; const char* name = lua_getlocal(state, record, i); ++i) {
      if (name[0] != '(') look_at_local(state, name, is_of_script);
      lua_settop(state, top);
    }
  } catch (const std::exception&) {
    lua_settop(state, top);  // a name that cannot be reported must not end a run
  }
}

void note_all_locals(lua_State* state) noexcept {
  lua_Debug record;
  for (int level = 0; level < k_most_levels && lua_getstack(state, level, &record); ++level) note_locals(state, &record);
}

}  // namespace sterna::scripting
