// Frames between Lua and its C functions own no C++ object (see script_call.h); what does is marked noexcept and called from them.
#include "scripting/script_run.h"

#include <lua.hpp>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>

#include "geom/base/error.h"
#include "scripting/script_verbs.h"

namespace sterna::scripting {
namespace {

/// Lua instructions between two looks at the stop token: about 0.1 ms.
constexpr int k_instructions_per_check = 10000;

// ---- Memory --------------------------------------------------------------------------------------------------------------------------------

struct Memory {
  std::size_t used = 0;
  std::size_t limit = 0;
};

void* allocate(void* data, void* block, std::size_t old_size, std::size_t new_size) {
  auto& memory = *static_cast<Memory*>(data);
  if (!block) old_size = 0;  // then Lua passes the kind of the object there
  if (new_size == 0) {
    std::free(block);
    memory.used -= old_size;
    return nullptr;
  }
  if (new_size > old_size && memory.used + (new_size - old_size) > memory.limit) return nullptr;
  void* moved = std::realloc(block, new_size);
  if (moved) memory.used += new_size - old_size;
  return moved;
}

// ---- Stop ----------------------------------------------------------------------------------------------------------------------------------

bool take_stop(ScriptSession& session) noexcept {
  if (!session.context.stop_token().stop_requested()) return false;
  session.value = session.cancelled;
  return true;
}

void check_stop_hook(lua_State* state, lua_Debug*) {
  if (!take_stop(session_of(state))) return;
  // From now on every instruction stops, so that a script's own pcall cannot go on.
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

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw Error({.code = ErrorCode::file_not_found, .attempted = "reading " + path.string(), .problem = "the script cannot be opened"});
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Leaves the module's source in session.value; false: its error.
bool read_module(ScriptSession& session, const char* name) noexcept {
  try {
    const std::string module = name;
    if (module.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") != std::string::npos)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "require \"" + module + "\"",
                   .problem = "modules lie beside the script and are named with letters, digits, - and _"});
    session.value = read_text(session.script.parent_path() / (module + ".lua"));
    return true;
  } catch (const Error& error) {
    session.value = std::make_shared<const Error>(error);
    return false;
  }
}

int require(lua_State* state) {
  const char* name = luaL_checkstring(state, 1);
  lua_pushvalue(state, 1);
  if (lua_rawget(state, lua_upvalueindex(1)) != LUA_TNIL) return 1;
  lua_pop(state, 1);
  ScriptSession& session = session_of(state);
  if (!read_module(session, name)) raise_failure(state);
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

/// math.randomseed() without a number would seed from the clock; here it starts the run's own sequence again.
int random_seed(lua_State* state) {
  const int n = lua_gettop(state);
  lua_pushvalue(state, lua_upvalueindex(1));
  if (n == 0) lua_pushinteger(state, static_cast<lua_Integer>(session_of(state).context.seed()));
  for (int i = 1; i <= n; ++i) lua_pushvalue(state, i);
  lua_call(state, n == 0 ? 1 : n, 0);
  return 0;
}

/// Lua seeds the order of its tables from addresses and the clock, so two runs of one script could differ. Here pairs() goes through numbers, then texts, in
/// ascending order; keys of other kinds come last, in Lua's order. Entries that are removed on the way are left out.
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

void open_libraries(lua_State* state) {
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

/// A name that nothing has would be nil, and a table drops what is nil: unit = parsec would silently be no unit at all.
int unknown_global(lua_State* state) {
  if (lua_type(state, 2) != LUA_TSTRING) return 0;
  return luaL_error(state, "unknown name (global '%s')", lua_tostring(state, 2));
}

void refuse_unknown_globals(lua_State* state) {
  lua_pushglobaltable(state);
  lua_newtable(state);
  lua_pushcfunction(state, unknown_global);
  lua_setfield(state, -2, "__index");
  lua_setmetatable(state, -2);
  lua_pop(state, 1);
}

void register_verbs(lua_State* state) {
  register_objects(state);
  for (const ScriptVerb& verb : script_verbs()) {
    push_verb(state, verb);
    lua_setglobal(state, verb.name.data());
  }
  for (const ScriptUnit& unit : script_units()) {
    lua_pushnumber(state, unit.value);
    lua_setglobal(state, unit.name);
  }
}

struct Source {
  const std::string* text;
  const std::string* chunk_name;
};

/// Runs protected; argument 1 is the Source.
int run_source(lua_State* state) {
  const auto& source = *static_cast<const Source*>(lua_touserdata(state, 1));
  open_libraries(state);
  register_verbs(state);
  refuse_unknown_globals(state);
  lua_sethook(state, check_stop_hook, LUA_MASKCOUNT, k_instructions_per_check);
  if (luaL_loadbufferx(state, source.text->data(), source.text->size(), source.chunk_name->c_str(), "t") != LUA_OK) return lua_error(state);
  lua_call(state, 0, 0);
  return 0;
}

void log_text(ScriptSession& session, const char* text) noexcept { session.context.debug(text); }

/// Logs where a plain Lua error came from; the error itself stays as it is.
int add_traceback(lua_State* state) {
  if (lua_type(state, 1) == LUA_TSTRING) {
    luaL_traceback(state, state, lua_tostring(state, 1), 1);
    log_text(session_of(state), lua_tostring(state, -1));
  }
  lua_settop(state, 1);
  return 1;
}

/// Lua's own message, with a suggestion where a verb or unit is misspelt.
Error with_suggestion(const Error& error) {
  if (error.code() != ErrorCode::script_failed) return error;
  ErrorInfo info = error.info();
  std::smatch match;
  if (std::regex_search(info.problem, match, std::regex("\\(global '(\\w+)'\\)")))
    if (const std::string nearest = nearest_global(match[1].str()); !nearest.empty()) info.hint = "did you mean " + nearest + "?";
  return Error(std::move(info));
}

struct CloseState {
  void operator()(lua_State* state) const { lua_close(state); }
};

void check_overrides(const OptionOverrides& overrides) {
  surfmesh::StitchOptions surface;
  volmesh::VolumeMeshOptions volume;
  UnionOptions unite;
  surfmesh::SurfaceMeshOptions surface_mesh;
  OptionTable table = all_options(surface, volume);
  for (OptionTable more : {sterna::options_of(unite), sterna::options_of(surface_mesh)})
    for (Option& option : more) table.push_back(std::move(option));
  for (const auto& [name, text] : overrides) set_option_as_typed(find_option(table, name, "--set " + name), text);
}

}  // namespace

void run_script(const ScriptSettings& settings, const RunContext& context) {
  check_overrides(settings.overrides);
  ScriptSession session{
      .context = context,
      .script = settings.script,
      .overrides = settings.overrides,
      .print = settings.print,
      .on_mesh = settings.on_mesh,
      .cancelled = std::make_shared<const Error>(
          ErrorInfo{.code = ErrorCode::cancelled, .attempted = settings.script.string(), .problem = "stopped on request", .places = {}, .hint = {}, .geometry = {}}),
      .value = {}};
  const std::string text = read_text(settings.script);
  const std::string chunk_name = "@" + settings.script.string();
  Source source{&text, &chunk_name};

  Memory memory{.used = 0, .limit = settings.memory_limit};
  const std::unique_ptr<lua_State, CloseState> owner(lua_newstate(allocate, &memory));
  if (!owner) throw Error({.code = ErrorCode::overflow, .attempted = "starting Lua", .problem = "not enough memory"});
  lua_State* state = owner.get();
  set_session(state, session);
  lua_pushcfunction(state, add_traceback);
  lua_pushcfunction(state, run_source);
  lua_pushlightuserdata(state, &source);
  const int status = lua_pcall(state, 1, 0, 1);
  if (status == LUA_ERRMEM)
    throw Error({.code = ErrorCode::script_failed,
                 .attempted = settings.script.string(),
                 .problem = "the script needs more than " + std::to_string(memory.limit >> 20) + " MiB for its own values"});
  if (status != LUA_OK) throw with_suggestion(error_on_top(state));
}

}  // namespace sterna::scripting
