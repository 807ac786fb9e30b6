#include "scripting/script_call.h"

#include <lua.hpp>

#include <new>
#include <span>

#include "scripting/component_verbs.h"
#include "scripting/geometry_verbs.h"
#include "scripting/model_methods.h"
#include "scripting/script_function.h"
#include "scripting/script_verbs.h"
#include "scripting/stage_verbs.h"

namespace sterna::scripting {
namespace {

/// Nested tables deeper than this are a loop of references.
constexpr int k_max_depth = 16;
/// Lua stack slots that reading one level of a table needs.
constexpr int k_slots_per_level = 8;

/// The contents of every userdata of ours; the key of the same address marks our metatables.
struct ObjectBox {
  ScriptValue value;
};
const char k_box_tag = 0;
constexpr const char* k_surface_type = "sterna.surface";
constexpr const char* k_envelope_type = "sterna.envelope";
constexpr const char* k_tetrahedra_type = "sterna.tetrahedra";
constexpr const char* k_mesh_type = "sterna.mesh";
constexpr const char* k_model_type = "sterna.model";
constexpr const char* k_component_type = "sterna.component";
constexpr const char* k_airfoil_type = "sterna.airfoil";
constexpr const char* k_error_type = "sterna.error";
constexpr const char* k_shape_type = "sterna.shape";

// ---- Reading: only functions of Lua that never raise, and protected calls ------------------------------------------------------------------------------------

ObjectBox* box_at(lua_State* state, int index) {
  if (lua_type(state, index) != LUA_TUSERDATA || !lua_getmetatable(state, index)) return nullptr;
  const bool is_ours = lua_rawgetp(state, -1, &k_box_tag) != LUA_TNIL;
  lua_pop(state, 2);
  return is_ours ? static_cast<ObjectBox*>(lua_touserdata(state, index)) : nullptr;
}

int call_verb(lua_State* state);

ScriptValue read_value(lua_State* state, int index, int depth);

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
      table->fields.emplace(lua_tostring(state, key), read_value(state, key + 1, depth + 1));
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
    case LUA_TTABLE: return read_table(state, index, depth);
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

/// "case.lua:5: " of the nearest Lua function that is running.
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

ErrorHandle make_error(ErrorInfo info) { return std::make_shared<const Error>(std::move(info)); }

/// The verb's own error, with the user's file:line in front.
ErrorHandle placed(const Error& error, const ScriptCall& call) {
  ErrorInfo info = error.info();
  if (!info.attempted.starts_with(call.where)) info.attempted = call.where + info.attempted;
  return make_error(std::move(info));
}

bool run_verb(lua_State* state, ScriptSession& session, const ScriptVerb& verb) noexcept {
  ScriptCall call{.session = session, .where = where_of(state), .verb = verb.name, .arguments = {}};
  try {
    for (int i = 1; i <= lua_gettop(state); ++i) call.arguments.push_back(read_value(state, i, 0));
    session.value = verb.run(call);
    return true;
  } catch (const Error& error) {
    session.value = placed(error, call);
  } catch (const std::bad_alloc&) {
    session.value = make_error({.code = ErrorCode::overflow, .attempted = call.attempted(), .problem = "not enough memory"});
  } catch (const std::exception& error) {
    session.value = make_error({.code = ErrorCode::internal, .attempted = call.attempted(), .problem = error.what()});
  }
  return false;
}

// ---- Pushing: may raise, so no frame here owns a C++ object ------------------------------------------------------------------------------

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
  else if (std::holds_alternative<SurfaceHandle>(value)) push_object(state, value, k_surface_type);
  else if (std::holds_alternative<EnvelopeHandle>(value)) push_object(state, value, k_envelope_type);
  else if (std::holds_alternative<TetrahedraHandle>(value)) push_object(state, value, k_tetrahedra_type);
  else if (std::holds_alternative<MeshHandle>(value)) push_object(state, value, k_mesh_type);
  else if (std::holds_alternative<ModelHandle>(value)) push_object(state, value, k_model_type);
  else if (std::holds_alternative<ComponentHandle>(value)) push_object(state, value, k_component_type);
  else if (std::holds_alternative<AirfoilHandle>(value)) push_object(state, value, k_airfoil_type);
  else if (std::holds_alternative<ErrorHandle>(value)) push_object(state, value, k_error_type);
  else lua_pushnil(state);
}

int call_verb(lua_State* state) {
  ScriptSession& session = session_of(state);
  const auto& verb = *static_cast<const ScriptVerb*>(lua_touserdata(state, lua_upvalueindex(1)));
  if (verb.is_heavy) lua_gc(state, LUA_GCCOLLECT);
  if (!run_verb(state, session, verb)) raise_failure(state);
  push_value(state, session.value);
  session.value = std::monostate{};  // the script alone decides how long a mesh lives
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

void register_type(lua_State* state, const char* type, const ScriptVerb& describe, const ScriptVerb& field, std::span<const ScriptVerb> methods) {
  luaL_newmetatable(state, type);
  lua_pushboolean(state, 1);
  lua_rawsetp(state, -2, &k_box_tag);
  lua_pushstring(state, "locked");  // getmetatable must not hand out __gc
  lua_setfield(state, -2, "__metatable");
  lua_pushcfunction(state, collect_object);
  lua_setfield(state, -2, "__gc");
  push_verb(state, describe);
  lua_setfield(state, -2, "__tostring");
  lua_pushlightuserdata(state, const_cast<ScriptVerb*>(&field));
  lua_createtable(state, 0, static_cast<int>(methods.size()));
  for (const ScriptVerb* method = methods.data(); method != methods.data() + methods.size(); ++method) {
    push_verb(state, *method);
    lua_setfield(state, -2, method->name.data() + method->name.find(':') + 1);
  }
  lua_pushcclosure(state, index_object, 2);
  lua_setfield(state, -2, "__index");
  lua_pop(state, 1);
}

}  // namespace

void push_verb(lua_State* state, const ScriptVerb& verb) {
  lua_pushlightuserdata(state, const_cast<ScriptVerb*>(&verb));
  lua_pushcclosure(state, call_verb, 1);
}

void register_objects(lua_State* state) {
  register_type(state, k_surface_type, k_describe_object, k_surface_field, surface_methods());
  register_type(state, k_envelope_type, k_describe_object, k_envelope_field, envelope_methods());
  register_type(state, k_tetrahedra_type, k_describe_object, k_tetrahedra_field, tetrahedra_methods());
  register_type(state, k_mesh_type, k_describe_object, k_mesh_field, mesh_methods());
  register_type(state, k_model_type, k_describe_object, k_model_field, model_methods());
  register_type(state, k_component_type, k_describe_object, k_component_field, component_methods());
  register_type(state, k_airfoil_type, k_describe_object, k_airfoil_field, {});
  register_type(state, k_error_type, k_describe_object, k_error_field, {});
  luaL_newmetatable(state, k_shape_type);
  push_verb(state, k_describe_object);
  lua_setfield(state, -2, "__tostring");
  lua_pop(state, 1);
}

ScriptSession& session_of(lua_State* state) noexcept { return **static_cast<ScriptSession**>(lua_getextraspace(state)); }
void set_session(lua_State* state, ScriptSession& session) noexcept { *static_cast<ScriptSession**>(lua_getextraspace(state)) = &session; }

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
                .problem = "error() was called with " + std::string(lua_typename(state, lua_type(state, -1))) + " instead of a text"});
}

}  // namespace sterna::scripting
