#include "scripting/lua/script_call.h"

#include <lua.hpp>

#include <span>

#include "scripting/lua/foreign_error.h"
#include "scripting/lua/quantity.h"
#include "scripting/lua/script_check.h"
#include "scripting/lua/script_function.h"
#include "scripting/lua/script_hooks.h"
#include "scripting/lua/script_sandbox.h"
#include "scripting/lua/script_unknowns.h"
#include "scripting/lua/script_watch.h"

namespace sterna::scripting {
namespace {

/// Tables nested deeper than this are a cycle of references.
constexpr int k_max_depth = 16;
/// Lua stack slots needed to read one level of a table.
constexpr int k_slots_per_level = 8;

/// The content of every userdata of sterna; the key of the same address marks the metatables of sterna.
struct ObjectBox {
  ScriptValue value;
};
const char k_box_tag = 0;
/// Key in the metatable of a table that can be called as a verb: the verb.
const char k_verb_tag = 0;
constexpr const char* k_shape_type = "sterna.shape";

// ---- Reading: uses only functions of Lua that never raise, and protected calls ----------------------------------------------------------------

ObjectBox* box_at(lua_State* state, int index) {
  if (lua_type(state, index) != LUA_TUSERDATA || !lua_getmetatable(state, index)) return nullptr;
  const bool is_ours = lua_rawgetp(state, -1, &k_box_tag) != LUA_TNIL;
  lua_pop(state, 2);
  return is_ours ? static_cast<ObjectBox*>(lua_touserdata(state, index)) : nullptr;
}

int call_verb(lua_State* state);

ScriptValue read_value(lua_State* state, int index, int depth);

/// Returns true if a table is an unknown value of a script that is only checked (script_unknowns.h).
bool is_unknown_table(lua_State* state, int index) {
  if (!lua_getmetatable(state, index)) return false;
  luaL_getmetatable(state, k_unknown_type);
  const bool is_same = lua_rawequal(state, -1, -2) != 0;
  lua_pop(state, 2);
  return is_same;
}

const ScriptVerb* verb_of_table(lua_State* state, int index) {
  if (!lua_getmetatable(state, index)) return nullptr;
  lua_rawgetp(state, -1, &k_verb_tag);
  const auto* verb = static_cast<const ScriptVerb*>(lua_touserdata(state, -1));
  lua_pop(state, 2);
  return verb;
}

std::shared_ptr<const ScriptTable> read_table(lua_State* state, int index, int depth) {
  auto table = std::make_shared<ScriptTable>();
  if (depth > k_max_depth || !lua_checkstack(state, k_slots_per_level))
    throw Error({.code = ErrorCode::bad_argument, .attempted = "reading a table", .problem = "tables are nested more than 16 deep"});
  const lua_Unsigned n = lua_rawlen(state, index);
  for (lua_Unsigned i = 1; i <= n; ++i) {
    lua_rawgeti(state, index, static_cast<lua_Integer>(i));
    table->items.push_back(read_value(state, lua_gettop(state), depth + 1));
    lua_pop(state, 1);
  }
  lua_pushnil(state);
  while (lua_next(state, index) != 0) {
    const int key = lua_gettop(state) - 1;
    if (lua_type(state, key) == LUA_TSTRING) {
      ScriptValue value = read_value(state, key + 1, depth + 1);
      if (is_unknown(value)) table->unknown_fields.emplace_back(lua_tostring(state, key));
      else table->fields.emplace(lua_tostring(state, key), std::move(value));
    } else if (!lua_isinteger(state, key) || lua_tointeger(state, key) < 1 || static_cast<lua_Unsigned>(lua_tointeger(state, key)) > n) {
      table->other_keys.push_back(lua_isinteger(state, key) ? "[" + std::to_string(lua_tointeger(state, key)) + "]"
                                                            : "[" + std::string(lua_typename(state, lua_type(state, key))) + "]");
    }
    lua_pop(state, 1);
  }
  return table;
}

ScriptValue read_value(lua_State* state, int index, int depth) {
  switch (lua_type(state, index)) {
    case LUA_TNONE:
    case LUA_TNIL: return std::monostate{};
    case LUA_TBOOLEAN: return lua_toboolean(state, index) != 0;
    case LUA_TNUMBER:
      if (lua_isinteger(state, index)) return static_cast<std::int64_t>(lua_tointeger(state, index));
      return lua_tonumber(state, index);
    case LUA_TSTRING: {
      std::size_t size = 0;
      const char* text = lua_tolstring(state, index, &size);
      return std::string(text, size);
    }
    case LUA_TTABLE:
      if (is_unknown_table(state, index)) return OpaqueValue{k_unknown_value};
      if (const ScriptVerb* verb = verb_of_table(state, index)) return verb;
      return read_table(state, index, depth);
    case LUA_TUSERDATA:
      if (const ObjectBox* box = box_at(state, index)) return box->value;
      break;
    case LUA_TFUNCTION:
      if (lua_tocfunction(state, index) == call_verb && lua_getupvalue(state, index, 1)) {
        const auto* verb = static_cast<const ScriptVerb*>(lua_touserdata(state, -1));
        lua_pop(state, 1);
        return verb;
      }
      return FunctionHandle(std::make_shared<const ScriptFunction>(state, index));
    default: break;
  }
  return OpaqueValue{lua_typename(state, lua_type(state, index))};
}

ErrorHandle make_error(ErrorInfo info) { return std::make_shared<const Error>(std::move(info)); }

/// Returns the verb's own error, with the user's file:line in front.
ErrorHandle placed(const Error& error, const ScriptCall& call) {
  ErrorInfo info = error.info();
  if (!info.attempted.starts_with(call.where)) info.attempted = call.where + info.attempted;
  return make_error(std::move(info));
}

/// For a script that is only checked: notes the problem, and continues with a placeholder for the result, unless the script catches the error itself.
bool goes_on(lua_State* state, const ScriptVerb& verb, const ScriptCall& call, ErrorHandle error) {
  if (!call.session.check || error->code() == ErrorCode::cancelled || is_protected(state)) return false;
  call.session.check->problems.push_back(std::move(error));
  call.session.value = verb.gives.empty() ? ScriptValue(OpaqueValue{k_unknown_value}) : placeholder(call, verb.gives);
  return true;
}

/// Returns true if an argument is an unknown value of a script that is only checked. The call then cannot be checked.
bool is_about_unknown(const ScriptCall& call) {
  const auto has_unknown = [](const std::vector<ScriptValue>& values) { return std::ranges::any_of(values, is_unknown); };
  if (has_unknown(call.arguments)) return true;
  return std::ranges::any_of(call.arguments, [&](const ScriptValue& argument) {
    const auto* table = std::get_if<TableHandle>(&argument);
    return table && *table && has_unknown((*table)->items);
  });
}

bool run_verb(lua_State* state, ScriptSession& session, const ScriptVerb& verb) noexcept {
  ScriptCall call{.session = session, .where = where_of(state), .verb = verb.name, .arguments = {}, .is_heavy = verb.is_heavy};
  try {
    for (int i = 1; i <= lua_gettop(state); ++i) call.arguments.push_back(read_value(state, i, 0));
    call.is_geometry = verb.is_heavy && is_geometry_made(call, verb);
    call.is_heavy = verb.is_heavy && !call.is_geometry;
    if (session.check && is_about_unknown(call)) session.value = verb.gives.empty() ? ScriptValue(OpaqueValue{k_unknown_value}) : placeholder(call, verb.gives);
    else session.value = session.hooks->run(verb, call);
    if (session.watch && !object_name(session.value).empty()) session.watch->made(call, session.value);
    return true;
  } catch (const ChecksDone&) {
    session.value = placeholder(call, verb.gives);
    return true;
  } catch (const Error& error) {
    ErrorHandle of_user = placed(error, call);
    if (goes_on(state, verb, call, of_user)) return true;
    session.value = std::move(of_user);
  } catch (const std::exception& error) {
    session.value = make_error(foreign_error(error, call.attempted()));
  }
  return false;
}

// ---- Pushing: these functions may raise, so no frame here owns a C++ object ---------------------------------------------------------------------

const ObjectKind* kind_named(lua_State* state, std::string_view name) {
  for (const ObjectKind& kind : session_of(state).hooks->kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

void push_object(lua_State* state, const ScriptValue& value, const char* type) {
  auto* box = new (lua_newuserdatauv(state, sizeof(ObjectBox), 0)) ObjectBox;
  luaL_setmetatable(state, type);
  box->value = value;
}

void push_value(lua_State* state, const ScriptValue& value);

void push_table(lua_State* state, const ScriptTable& table) {
  luaL_checkstack(state, k_slots_per_level, nullptr);
  lua_createtable(state, static_cast<int>(table.items.size()), static_cast<int>(table.fields.size()));
  for (std::size_t i = 0; i < table.items.size(); ++i) {
    push_value(state, table.items[i]);
    lua_rawseti(state, -2, static_cast<lua_Integer>(i + 1));
  }
  for (auto it = table.fields.begin(); it != table.fields.end(); ++it) {
    push_value(state, it->second);
    lua_setfield(state, -2, it->first.c_str());
  }
  if (table.fields.contains("shape")) luaL_setmetatable(state, k_shape_type);
}

void push_value(lua_State* state, const ScriptValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) lua_pushboolean(state, *flag);
  else if (const auto* whole = std::get_if<std::int64_t>(&value)) lua_pushinteger(state, *whole);
  else if (const auto* number = std::get_if<double>(&value)) lua_pushnumber(state, *number);
  else if (const auto* text = std::get_if<std::string>(&value)) lua_pushlstring(state, text->data(), text->size());
  else if (const auto* table = std::get_if<std::shared_ptr<const ScriptTable>>(&value)) push_table(state, **table);
  else if (const ObjectKind* kind = kind_named(state, object_name(value))) push_object(state, value, kind->type);
  else if (is_unknown(value)) push_unknown(state);
  else lua_pushnil(state);
}

/// Ends any further verb in a worker whose case is over, even if the script catches the error that ends it.
bool take_end_of_case(ScriptSession& session) noexcept {
  if (!session.series.is_case_over) return false;
  session.value = session.cancelled;
  return true;
}

int call_verb(lua_State* state) {
  ScriptSession& session = session_of(state);
  if (take_end_of_case(session)) raise_failure(state);
  const auto& verb = *static_cast<const ScriptVerb*>(lua_touserdata(state, lua_upvalueindex(1)));
  if (verb.is_heavy) lua_gc(state, LUA_GCCOLLECT);
  if (!run_verb(state, session, verb)) raise_failure(state);
  push_value(state, session.value);
  session.value = std::monostate{};  // release the value here, so that only the script determines the lifetime of a mesh
  return 1;
}

// ---- Objects ---------------------------------------------------------------------------------------------------------------------------

int index_object(lua_State* state) {
  lua_pushvalue(state, 2);
  lua_rawget(state, lua_upvalueindex(2));
  if (!lua_isnil(state, -1)) return 1;
  lua_pop(state, 1);
  return call_verb(state);  // upvalue 1: the verb that reads a field
}

int collect_object(lua_State* state) {
  if (ObjectBox* box = box_at(state, 1)) box->value = std::monostate{};
  return 0;
}

void register_type(lua_State* state, const ObjectKind& kind) {
  const std::span<const ScriptVerb> methods = kind.methods();
  luaL_newmetatable(state, kind.type);
  lua_pushboolean(state, 1);
  lua_rawsetp(state, -2, &k_box_tag);
  lua_pushstring(state, "locked");  // getmetatable must not expose __gc
  lua_setfield(state, -2, "__metatable");
  lua_pushcfunction(state, collect_object);
  lua_setfield(state, -2, "__gc");
  push_verb(state, *session_of(state).hooks->describe);
  lua_setfield(state, -2, "__tostring");
  lua_pushlightuserdata(state, const_cast<ScriptVerb*>(kind.field));
  lua_createtable(state, 0, static_cast<int>(methods.size()));
  for (const ScriptVerb* method = methods.data(); method != methods.data() + methods.size(); ++method) {
    push_verb(state, *method);
    lua_setfield(state, -2, method->name.data() + method->name.find(':') + 1);
  }
  lua_pushcclosure(state, index_object, 2);
  lua_setfield(state, -2, "__index");
  lua_pop(state, 1);
}

// ---- Arithmetic with lengths that store their origin: the result, as of 1.3 * boundary_layer{...}, is a plain number --------------------------------

/// Pushes the operand as a number. Other operands are pushed unchanged, so that Lua reports an error for them. May raise.
void push_operand(lua_State* state, int index) {
  const ObjectBox* box = box_at(state, index);
  const QuantityHandle* quantity = box ? std::get_if<QuantityHandle>(&box->value) : nullptr;
  if (!quantity) lua_pushvalue(state, index);
  else if (!(*quantity)->is_length()) luaL_error(state, "flow conditions are not a number");
  else lua_pushnumber(state, (*quantity)->metres);
}

int calculate(lua_State* state) {
  const int operation = static_cast<int>(lua_tointeger(state, lua_upvalueindex(1)));
  push_operand(state, 1);
  if (operation != LUA_OPUNM) push_operand(state, 2);
  lua_arith(state, operation);
  return 1;
}

int compare(lua_State* state) {
  push_operand(state, 1);
  push_operand(state, 2);
  lua_pushboolean(state, lua_compare(state, -2, -1, static_cast<int>(lua_tointeger(state, lua_upvalueindex(1)))));
  return 1;
}

void register_arithmetic(lua_State* state, const char* type) {
  luaL_getmetatable(state, type);
  const auto add = [state](const char* event, lua_CFunction function, int operation) {
    lua_pushinteger(state, operation);
    lua_pushcclosure(state, function, 1);
    lua_setfield(state, -2, event);
  };
  add("__add", calculate, LUA_OPADD);
  add("__sub", calculate, LUA_OPSUB);
  add("__mul", calculate, LUA_OPMUL);
  add("__div", calculate, LUA_OPDIV);
  add("__pow", calculate, LUA_OPPOW);
  add("__unm", calculate, LUA_OPUNM);
  add("__eq", compare, LUA_OPEQ);
  add("__lt", compare, LUA_OPLT);
  add("__le", compare, LUA_OPLE);
  lua_pop(state, 1);
}

}  // namespace

void push_verb(lua_State* state, const ScriptVerb& verb) {
  lua_pushlightuserdata(state, const_cast<ScriptVerb*>(&verb));
  lua_pushcclosure(state, call_verb, 1);
}

void push_verb_table(lua_State* state, const ScriptVerb& verb, const ScriptVerb& field) {
  lua_newtable(state);
  lua_newtable(state);
  lua_pushlightuserdata(state, const_cast<ScriptVerb*>(&verb));
  lua_rawsetp(state, -2, &k_verb_tag);
  push_verb(state, verb);
  lua_setfield(state, -2, "__call");
  push_verb(state, field);
  lua_setfield(state, -2, "__index");
  lua_pushstring(state, "locked");
  lua_setfield(state, -2, "__metatable");
  lua_setmetatable(state, -2);
}

void register_objects(lua_State* state) {
  const std::span<const ObjectKind> kinds = session_of(state).hooks->kinds();
  for (const ObjectKind* kind = kinds.data(); kind != kinds.data() + kinds.size(); ++kind) register_type(state, *kind);
  register_arithmetic(state, kind_named(state, "quantity")->type);
  luaL_newmetatable(state, k_shape_type);
  push_verb(state, *session_of(state).hooks->describe);
  lua_setfield(state, -2, "__tostring");
  lua_pop(state, 1);
}

ScriptSession& session_of(lua_State* state) noexcept { return **static_cast<ScriptSession**>(lua_getextraspace(state)); }
void set_session(lua_State* state, ScriptSession& session) noexcept { *static_cast<ScriptSession**>(lua_getextraspace(state)) = &session; }

void push_script_value(lua_State* state, const ScriptValue& value) { push_value(state, value); }
ScriptValue script_value_at(lua_State* state, int index) { return read_value(state, lua_absindex(state, index), 0); }

void raise_failure(lua_State* state) {
  push_value(state, session_of(state).value);
  lua_error(state);
  __builtin_unreachable();
}

Error error_on_top(lua_State* state) {
  if (const ObjectBox* box = box_at(state, -1))
    if (const auto* error = std::get_if<ErrorHandle>(&box->value)) return **error;
  if (lua_type(state, -1) == LUA_TSTRING) return Error({.code = ErrorCode::script_failed, .attempted = {}, .problem = lua_tostring(state, -1)});
  return Error({.code = ErrorCode::script_failed,
                .attempted = session_of(state).script.string(),
                .problem = "error() was called with " + std::string(lua_typename(state, lua_type(state, -1))) + " instead of a string"});
}

}  // namespace sterna::scripting
