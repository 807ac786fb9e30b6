// Steps: find the context at the end of the text (open tables and their verbs; inside a string or not) and the word there; collect the candidates that are
// possible in this context; keep those that begin with the word.
#include "scripting/interpreter/completion.h"

#include <lua.hpp>

#include <algorithm>
#include <array>
#include <cctype>

#include "scripting/interpreter/script_help.h"
#include "scripting/interpreter/script_objects.h"
#include "scripting/interpreter/script_verbs.h"
#include "scripting/lua/script_call.h"
#include "scripting/values/models.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {
namespace {

constexpr std::array k_keywords = {"and",   "break", "do",  "else", "elseif", "end",    "false", "for",  "function", "if",   "in",
                                   "local", "nil",   "not", "or",   "repeat", "return", "then",  "true", "until",    "while"};

bool is_word_letter(char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)); }

/// A brace or bracket that is still open, with the name before it.
struct Opening {
  char bracket;
  std::string name;
};

struct CursorLocation {
  std::vector<Opening> open;
  bool is_text = false;
};

/// Returns the name that ends at `end`: "volume_mesh", "mesh:check", or "farfield" of `farfield = {`.
std::string name_before(std::string_view text, std::size_t end) {
  const auto skip_blanks = [&] {
    while (end > 0 && std::isspace(static_cast<unsigned char>(text[end - 1]))) --end;
  };
  skip_blanks();
  if (end > 0 && text[end - 1] == '=') {
    --end;
    skip_blanks();
  }
  std::size_t start = end;
  while (start > 0 && (is_word_letter(text[start - 1]) || text[start - 1] == ':' || text[start - 1] == '.')) --start;
  return std::string(text.substr(start, end - start));
}

CursorLocation location_at_end(std::string_view text) {
  CursorLocation location;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote) {
      if (c == '\\') ++i;
      else if (c == quote) quote = 0;
    } else if (c == '-' && text.substr(i).starts_with("--")) {
      i = std::min(text.find('\n', i), text.size());
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '{' || c == '(') {
      location.open.push_back({c, name_before(text, i)});
    } else if ((c == '}' || c == ')') && !location.open.empty()) {
      location.open.pop_back();
    }
  }
  location.is_text = quote != 0;
  return location;
}

// ---- Values of the script, by raw access only, so that no code of the script runs -------------------------------------------------------------------------

/// Pushes the value of a path of names, "design.wing"; nil if there is none. Fields of objects are not followed.
void push_path(lua_State* state, std::string_view path) {
  lua_pushglobaltable(state);
  while (!path.empty() && lua_type(state, -1) == LUA_TTABLE) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    lua_pushlstring(state, path.data(), dot);
    lua_rawget(state, -2);
    lua_remove(state, -2);
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
}

/// Adds the keys of the table on top of the stack that are names, with the prefix `of`.
void add_keys(lua_State* state, const std::string& of, std::vector<std::string>& names) {
  lua_pushnil(state);
  while (lua_next(state, -2) != 0) {
    lua_pop(state, 1);
    if (lua_type(state, -1) == LUA_TSTRING) names.push_back(of + lua_tostring(state, -1));
  }
}

const ObjectKind* kind_on_top(lua_State* state) {
  if (lua_type(state, -1) != LUA_TUSERDATA || !lua_getmetatable(state, -1)) return nullptr;
  const ObjectKind* found = nullptr;
  for (const ObjectKind& kind : object_kinds()) {
    luaL_getmetatable(state, kind.type);
    if (lua_rawequal(state, -1, -2)) found = &kind;
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
  return found;
}

std::vector<std::string> globals(lua_State* state) {
  std::vector<std::string> names(k_keywords.begin(), k_keywords.end());
  lua_pushglobaltable(state);
  add_keys(state, "", names);
  lua_settop(state, 0);
  return names;
}

/// Returns the candidates after "wall." or "wall:".
std::vector<std::string> members(lua_State* state, const std::string& path, char separator) {
  std::vector<std::string> names;
  push_path(state, path);
  const std::string of = path + separator;
  if (const ObjectKind* kind = kind_on_top(state)) {
    for (const ScriptVerb& method : kind->methods())
      if (separator == ':') names.push_back(of + std::string(method.name.substr(method.name.find(':') + 1)));
    for (const FieldDoc& field : kind->fields)
      if (separator == '.') names.push_back(of + std::string(field.name));
  } else if (lua_type(state, -1) == LUA_TTABLE) {
    add_keys(state, of, names);
  }
  lua_settop(state, 0);
  return names;
}

/// Entries whose strings are names of patches.
constexpr std::array k_patch_entries = {"patches", "boundaries", "kinds", "monitor", "wing", "farfield_sides"};

/// Returns true if a string that names patches begins there: `patches = { ["` or `monitor = "`.
bool needs_patches(const CursorLocation& location, std::string_view text) {
  const auto is_one = [](std::string_view name) {
    return std::ranges::any_of(k_patch_entries, [&](const char* entry) { return name == entry || name.ends_with(std::string(":") + entry); });
  };
  const std::size_t quote = text.find_last_of("\"'");
  const std::string before = quote == std::string_view::npos ? std::string() : name_before(text, quote);
  return is_one(before) || (!location.open.empty() && is_one(location.open.back().name));
}

/// Returns the names of patches of the objects in the script's globals.
std::vector<std::string> patch_names(lua_State* state) {
  std::vector<std::string> names;
  const auto add = [&](const auto& patches) {
    for (const auto& patch : patches) names.push_back(patch.name);
  };
  lua_pushglobaltable(state);
  lua_pushnil(state);
  while (lua_next(state, -2) != 0) {
    if (kind_on_top(state)) {
      const ScriptValue value = script_value_at(state, -1);
      if (const auto* surface = std::get_if<SurfaceHandle>(&value)) add((*surface)->mesh.patches);
      if (const auto* mesh = std::get_if<MeshHandle>(&value)) add((*mesh)->mesh.patches);
      if (const auto* model = std::get_if<ModelHandle>(&value)) add((*model)->model.faces);
    }
    lua_pop(state, 1);
  }
  lua_settop(state, 0);
  return names;
}

// ---- Options -------------------------------------------------------------------------------------------------------------------------------

/// Returns the verb that is called "mesh:check" or "volume_mesh" at the prompt.
const ScriptVerb* verb_called(std::string_view name) {
  for (const ScriptVerb& verb : script_verbs())
    if (verb.name == name) return &verb;
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? nullptr : find_verb(name.substr(colon + 1));
}

/// Returns the options of the innermost open table. These are all options of its verb; in `farfield = {` they are those with this prefix, without the prefix.
std::vector<std::string> options_at(const CursorLocation& location) {
  std::string stage;
  for (auto it = location.open.rbegin(); it != location.open.rend(); ++it) {
    if (it->bracket != '{') return {};
    const ScriptVerb* verb = verb_called(it->name);
    if (!verb) {
      if (stage.empty()) stage = it->name;
      continue;
    }
    std::vector<std::string> names = option_names(*verb);
    if (stage.empty()) return names;
    std::vector<std::string> short_names;
    for (const std::string& name : names)
      if (name.starts_with(stage + "_")) short_names.push_back(name.substr(stage.size() + 1));
    return short_names.empty() ? names : short_names;
  }
  return {};
}

/// Keeps the candidates that begin with the word, sorted, each once.
void keep_those_of(const std::string& word, std::vector<std::string>& candidates) {
  std::erase_if(candidates, [&](const std::string& candidate) { return !candidate.starts_with(word); });
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
}

}  // namespace

Completion complete(std::string_view text, ScriptState& state) {
  const CursorLocation location = location_at_end(text);
  std::size_t start = text.size();
  while (start > 0 && (is_word_letter(text[start - 1]) || text[start - 1] == '.' || text[start - 1] == ':')) --start;
  Completion result{.start = start, .candidates = {}, .is_text = location.is_text};
  if (location.is_text && !needs_patches(location, text)) return result;
  const std::string word(text.substr(start));
  if (location.is_text) {
    result.candidates = patch_names(state.lua());
    keep_those_of(word, result.candidates);
    return result;
  }
  const std::size_t separator = word.find_last_of(".:");
  if (separator != std::string::npos) {
    result.candidates = members(state.lua(), word.substr(0, separator), word[separator]);
  } else {
    result.candidates = globals(state.lua());
    for (const std::string& option : options_at(location)) result.candidates.push_back(option + " = ");
  }
  keep_those_of(word, result.candidates);
  return result;
}

}  // namespace sterna::scripting
