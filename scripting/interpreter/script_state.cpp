// Frames between Lua and its C functions own no C++ object (see script_call.h); functions that own one are marked noexcept and called from them.
#include "scripting/interpreter/script_state.h"

#include <lua.hpp>

#include <cstdlib>
#include <regex>
#include <set>

#include "geom/base/error.h"
#include "scripting/interpreter/declared_arguments.h"
#include "scripting/interpreter/placeholders.h"
#include "scripting/interpreter/script_args.h"
#include "scripting/interpreter/script_objects.h"
#include "scripting/interpreter/script_verbs.h"
#include "scripting/lua/script_hooks.h"
#include "scripting/lua/script_sandbox.h"
#include "scripting/lua/script_unknowns.h"
#include "scripting/lua/script_watch.h"
#include "scripting/series/series_plan.h"
#include "scripting/series/series_verbs.h"
#include "scripting/values/cached_model.h"
#include "scripting/values/script_key.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {
namespace {

/// Number of calls in a traceback, and search depth. They are limited because Lua counts from the innermost call each time, and an endless recursion is 200 000
/// calls deep.
constexpr int k_max_traced = 12;
constexpr int k_max_looked_at = 100;

// ---- Memory --------------------------------------------------------------------------------------------------------------------------------

struct Memory {
  std::size_t used = 0;
  std::size_t limit = 0;
};

void* allocate(void* data, void* block, std::size_t old_size, std::size_t new_size) {
  auto& memory = *static_cast<Memory*>(data);
  if (!block) old_size = 0;  // in this case Lua passes the kind of the object there
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

// ---- Verbs ---------------------------------------------------------------------------------------------------------------------------------

/// Reports a function that the table of that name does not have, such as "envelope.smoth".
int unknown_member(lua_State* state) {
  if (lua_type(state, 2) != LUA_TSTRING) return 0;
  return luaL_error(state, "unknown name ('%s.%s')", lua_tostring(state, lua_upvalueindex(1)), lua_tostring(state, 2));
}

/// Pushes the global table of that name, created if missing: envelope of envelope.smooth. Its functions cannot be replaced.
void push_group(lua_State* state, const char* verb, std::size_t size) {
  lua_pushglobaltable(state);
  lua_pushlstring(state, verb, size);
  if (lua_rawget(state, -2) == LUA_TNIL) {
    lua_pop(state, 1);
    lua_newtable(state);
    lua_newtable(state);
    lua_pushlstring(state, verb, size);
    lua_pushcclosure(state, unknown_member, 1);
    lua_setfield(state, -2, "__index");
    lua_pushstring(state, "locked");
    lua_setfield(state, -2, "__metatable");
    lua_setmetatable(state, -2);
    lua_pushlstring(state, verb, size);
    lua_pushvalue(state, -2);
    lua_rawset(state, -4);
  }
  lua_remove(state, -2);
}

void register_verbs(lua_State* state) {
  register_objects(state);
  for (const ScriptVerb& verb : script_verbs()) {
    if (const std::size_t dot = verb.name.find('.'); dot != std::string_view::npos) {
      push_group(state, verb.name.data(), dot);
      push_verb(state, verb);
      lua_setfield(state, -2, verb.name.data() + dot + 1);
      lua_pop(state, 1);
      continue;
    }
    if (&verb == &arguments_verb()) push_verb_table(state, verb, k_argument_field);
    else push_verb(state, verb);
    lua_setglobal(state, verb.name.data());
  }
  for (const ScriptUnit& unit : script_units()) {
    lua_pushnumber(state, unit.value);
    lua_setglobal(state, unit.name);
  }
}

int open_state(lua_State* state) {
  open_sandbox(state);
  if (session_of(state).check) open_unknowns(state);
  register_verbs(state);
  refuse_unknown_globals(state);
  watch_for_stop(state);
  return 0;
}

// ---- Running -------------------------------------------------------------------------------------------------------------------------------

struct Source {
  const std::string* text;
  const std::string* chunk_name;
  bool is_printed = false;
};

/// Runs a source in protected mode. Argument 1 is the Source.
int run_source(lua_State* state) {
  const auto& source = *static_cast<const Source*>(lua_touserdata(state, 1));
  if (luaL_loadbufferx(state, source.text->data(), source.text->size(), source.chunk_name->c_str(), "t") != LUA_OK) return lua_error(state);
  const int before = lua_gettop(state) - 1;
  lua_call(state, 0, source.is_printed ? LUA_MULTRET : 0);
  const int n = lua_gettop(state) - before;
  if (n == 0) return 0;
  lua_getglobal(state, "print");
  lua_insert(state, before + 1);
  lua_call(state, n, 0);
  return 0;
}

/// Collects the functions of the script that were running, innermost first; nothing if only the script itself was running.
void take_traceback(lua_State* state, std::string& traceback) noexcept {
  try {
    traceback.clear();
    lua_Debug record;
    int n_found = 0;
    for (int level = 1; level <= k_max_looked_at && lua_getstack(state, level, &record); ++level) {
      lua_getinfo(state, "nSl", &record);
      if (record.currentline <= 0) continue;
      if (++n_found > k_max_traced) continue;
      const std::string source = record.source[0] == '@' ? record.source + 1 : record.short_src;
      traceback += "\n  " + source + ":" + std::to_string(record.currentline) + ": in " +
                   (std::string_view(record.what) == "main" ? "the script"
                    : record.name                           ? "function " + std::string(record.name)
                                                            : "a function");
    }
    if (n_found > k_max_traced) traceback += "\n  ... and more";
    if (n_found < 2) traceback.clear();
  } catch (const std::exception&) {
    traceback.clear();  // not enough memory for the traceback: the error itself is more important
  }
}

/// Returns Lua's own message, with a suggestion if a verb or unit is misspelt.
Error with_suggestion(const Error& error) {
  if (error.code() != ErrorCode::script_failed) return error;
  ErrorInfo info = error.info();
  std::smatch match;
  if (std::regex_search(info.problem, match, std::regex("\\((?:global )?'([\\w.]+)'\\)")))
    if (std::string hint = hint_for_global(match[1].str()); !hint.empty()) info.hint = std::move(hint);
  return Error(std::move(info));
}

struct CloseState {
  void operator()(lua_State* state) const { lua_close(state); }
};

void check_overrides(const OptionOverrides& overrides) {
  surfmesh::StitchOptions surface;
  volmesh::MeshCase volume;
  UnionOptions unite;
  surfmesh::SurfaceMeshOptions surface_mesh;
  surfmesh::RepairOptions repair;
  surfmesh::WrapOptions wrap;
  SeriesOptions series;
  OptionTable table = all_options(surface, volume);
  for (OptionTable more :
       {sterna::options_of(unite), sterna::options_of(surface_mesh), sterna::options_of(repair), sterna::options_of(wrap), options_of_series(series)})
    for (Option& option : more) table.push_back(std::move(option));
  for (const auto& [name, text] : overrides) set_option_as_typed(find_option(table, name, "--set " + name), text);
}

Error with_traceback(const Error& error, const std::string& traceback) {
  if (traceback.empty()) return error;
  ErrorInfo info = error.info();
  (info.hint.empty() ? info.problem : info.hint) += "\ncalled from, innermost first:" + traceback;
  return Error(std::move(info));
}

}  // namespace

namespace {

ScriptValue run_with_cache(const ScriptVerb& verb, const ScriptCall& call) {
  if (verb.is_heavy) refuse_unknown_arguments(call.session, false);
  if ((verb.name == "aircraft" || verb.name == "union") && is_sketch(call))
    return verb.run(call);  // the result is no union: it is not cached, and cached
                            // results must not be made from it
  return with_provenance(cached_model(verb, call), call);
}

const ScriptHooks k_hooks = {.kinds = object_kinds,
                             .describe = &k_describe_object,
                             .run = run_with_cache,
                             .placeholder = make_placeholder,
                             .set_option = set_option_as_typed,
                             .hint_for_global = hint_for_global};

}  // namespace

const ScriptHooks& script_hooks() { return k_hooks; }

struct ScriptState::Parts {
  ScriptSession session;
  Memory memory;
  std::string traceback;
  std::unique_ptr<lua_State, CloseState> owner;
};

namespace {

/// Notes the call stack of an error; the error itself is unchanged. Upvalue 1 is the string for the traceback.
int note_traceback(lua_State* state) {
  if (session_of(state).watch) note_all_locals(state);
  take_traceback(state, *static_cast<std::string*>(lua_touserdata(state, lua_upvalueindex(1))));
  return 1;
}

}  // namespace

ScriptState::ScriptState(const ScriptSettings& settings, const RunContext& context) {
  check_overrides(settings.overrides);
  parts_ = std::make_unique<Parts>(Parts{.session = {.context = context,
                                                     .script = settings.script,
                                                     .overrides = settings.overrides,
                                                     .print = settings.check ? [](std::string_view) {} : settings.print,
                                                     .on_mesh = settings.on_mesh,
                                                     .cache = settings.cache,
                                                     .cancelled = std::make_shared<const Error>(ErrorInfo{.code = ErrorCode::cancelled,
                                                                                                          .attempted = settings.script.string(),
                                                                                                          .problem = "stopped on request",
                                                                                                          .locations = {},
                                                                                                          .hint = {},
                                                                                                          .geometry = {}}),
                                                     .arguments = settings.arguments,
                                                     .check = settings.check,
                                                     .input_folder = settings.input_folder,
                                                     .series = {.settings = settings.series, .script_text = {}},
                                                     .hooks = &k_hooks,
                                                     .watch = settings.watch,
                                                     .value = {}},
                                         .memory = {.used = 0, .limit = settings.memory_limit},
                                         .traceback = {},
                                         .owner = {}});
  parts_->owner.reset(lua_newstate(allocate, &parts_->memory));
  if (!parts_->owner) throw Error({.code = ErrorCode::overflow, .attempted = "starting Lua", .problem = "not enough memory"});
  set_session(lua(), session());
  lua_pushcfunction(lua(), open_state);
  if (lua_pcall(lua(), 0, 0, 0) != LUA_OK)
    throw Error({.code = ErrorCode::overflow, .attempted = "starting Lua", .problem = "not enough memory for its libraries"});
}

ScriptState::~ScriptState() = default;

ScriptSession& ScriptState::session() { return parts_->session; }
lua_State* ScriptState::lua() { return parts_->owner.get(); }

namespace {

void run_protected(lua_State* state, Source source, std::string& traceback, std::size_t memory_limit) {
  lua_settop(state, 0);
  traceback.clear();
  lua_pushlightuserdata(state, &traceback);
  lua_pushcclosure(state, note_traceback, 1);
  lua_pushcfunction(state, run_source);
  lua_pushlightuserdata(state, &source);
  const int status = lua_pcall(state, 1, 0, 1);
  if (status == LUA_OK || session_of(state).series.is_case_over) return;  // in a worker whose case is over, the script ends by a stop, which is no error
  if (status == LUA_ERRMEM)
    throw Error({.code = ErrorCode::script_failed,
                 .attempted = session_of(state).script.string(),
                 .problem = "the script needs more than " + std::to_string(memory_limit >> 20) + " MiB for its Lua values"});
  const Error error = with_suggestion(error_on_top(state));
  lua_settop(state, 0);
  throw with_traceback(error, traceback);
}

}  // namespace

void ScriptState::run(const std::string& text, const std::string& name) {
  session().declared = {};  // each text is a separate script
  run_protected(lua(), {.text = &text, .chunk_name = &name}, parts_->traceback, parts_->memory.limit);
}

void ScriptState::run_and_print(const std::string& text, const std::string& name) {
  session().declared = {};
  run_protected(lua(), {.text = &text, .chunk_name = &name, .is_printed = true}, parts_->traceback, parts_->memory.limit);
}

bool ScriptState::is_correct(const std::string& text) {
  const int status = luaL_loadbufferx(lua(), text.data(), text.size(), "=prompt", "t");
  lua_settop(lua(), 0);
  return status == LUA_OK;
}

bool ScriptState::is_incomplete(const std::string& text) {
  const int status = luaL_loadbufferx(lua(), text.data(), text.size(), "=prompt", "t");
  std::size_t size = 0;
  const char* message = status == LUA_ERRSYNTAX ? lua_tolstring(lua(), -1, &size) : nullptr;
  const bool is_cut_off = message && std::string_view(message, size).ends_with("<eof>");
  lua_settop(lua(), 0);
  return is_cut_off;
}

}  // namespace sterna::scripting
