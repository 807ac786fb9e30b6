#include "scripting/lua/script_unknowns.h"

#include <lua.hpp>

#include <string_view>

#include "scripting/lua/script_call.h"
#include "scripting/lua/script_check.h"

namespace sterna::scripting {
namespace {

/// Has two upvalues: the metatable, and a function that returns true if a placeholder exists by now.
constexpr std::string_view k_prelude = R"lua(
local meta, has_stand_ins = ...
local setmetatable, getmetatable, rawequal, rawget, type, select, assert_truth = setmetatable, getmetatable, rawequal, rawget, type, select, assert
local known_entries = 3  -- ipairs of what is not known ends
local made = false
local function unknown()
  made = true
  return setmetatable({}, meta)
end
local function is_unknown(value) return type(value) == "table" and rawequal(getmetatable(value), meta) end
function meta.__index(_, key)
  if type(key) == "number" and (key < 1 or key > known_entries) then return nil end
  return unknown()
end
function meta.__newindex() end
for _, event in next, { "add", "sub", "mul", "div", "mod", "pow", "unm", "idiv", "band", "bor", "bxor", "shl", "shr", "bnot", "concat", "call" } do
  meta["__" .. event] = unknown
end
function meta.__lt() return true end
function meta.__le() return true end
function meta.__eq() return true end
function meta.__len() return 1 end
function meta.__tostring() return "(not made)" end
function meta.__pairs(t)
  return function(_, key)
    if key == nil then return unknown(), unknown() end
  end, t, nil
end
local function has_unknown(...)
  for i = 1, select("#", ...) do
    local value = select(i, ...)
    if is_unknown(value) then return true end
  end
  return false
end
local takes_anything = { insert = true, pack = true, remove = true }
local function letting_through(name, f)
  if type(f) ~= "function" or takes_anything[name] then return f end
  return function(...)
    if has_unknown(...) then return unknown() end
    return f(...)
  end
end
for _, library in next, { string, math, table, utf8 } do
  for name, f in next, library do library[name] = letting_through(name, f) end
end
local join = table.concat
function table.concat(list, ...)
  if type(list) == "table" then
    for i = 1, #list do
      if is_unknown(list[i]) then return unknown() end
    end
  end
  return join(list, ...)
end
tonumber = letting_through("tonumber", tonumber)
function assert(...)
  local truth = ...
  if truth or not (made or has_stand_ins()) then return assert_truth(...) end
  return ...
end
)lua";

int has_placeholders(lua_State* state) {
  const ScriptCheck* check = session_of(state).check;
  lua_pushboolean(state, check && !check->placeholders.empty());
  return 1;
}

}  // namespace

void open_unknowns(lua_State* state) {
  if (luaL_loadbufferx(state, k_prelude.data(), k_prelude.size(), "=check", "t") != LUA_OK) lua_error(state);
  luaL_newmetatable(state, k_unknown_type);
  lua_pushcfunction(state, has_placeholders);
  lua_call(state, 2, 0);
}

void push_unknown(lua_State* state) {
  lua_createtable(state, 0, 0);
  luaL_setmetatable(state, k_unknown_type);
}

}  // namespace sterna::scripting
