#include "scripting/interpreter/declared_arguments.h"

#include <algorithm>
#include <filesystem>

#include "geom/base/error.h"
#include "geom/base/schema.h"
#include "scripting/lua/lua_text.h"
#include "scripting/lua/script_watch.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/geometry_tools.h"

namespace sterna::scripting {
namespace {

/// Returns the sources of the run by their name in messages: "case.lua", "parts.lua".
std::vector<std::pair<std::string, const std::string*>> sources_of(const ScriptSession& session) {
  std::vector<std::pair<std::string, const std::string*>> sources = {{session.script.string(), &session.series.script_text}};
  for (const auto& [name, text] : session.series.modules) sources.emplace_back(name + ".lua", &text);
  return sources;
}

/// Converts "case.lua:5: " to "case.lua:5".
std::string location_of(const std::string& where) { return where.substr(0, where.rfind(": ")); }

/// Returns the position in the source of the name as a key or as a string of the args{} that begins at this location; npos if there is none.
std::size_t position_of(const std::string& source, std::size_t begin, const std::string& name) {
  const std::size_t as_key = find_word(source, begin, name);
  return std::min({as_key, source.find('"' + name + '"', begin), source.find('\'' + name + '\'', begin)});
}

/// Sorts the parameters in the order of the source, because Lua's tables have no order.
void sort_as_written(std::vector<ScriptParameter>& parameters, const ScriptSession& session, const std::string& location) {
  for (const auto& [file, source] : sources_of(session))
    for (const TableCall& call : table_calls(*source, "args"))
      if (location == file + ":" + std::to_string(line_of(*source, call.word)) || location == file + ":" + std::to_string(line_of(*source, call.begin)))
        return std::stable_sort(parameters.begin(), parameters.end(), [&](const ScriptParameter& a, const ScriptParameter& b) {
          return position_of(*source, call.begin, a.name) < position_of(*source, call.begin, b.name);
        });
}

bool is_same_value(const ScriptValue& a, const ScriptValue& b) {
  const auto number_a = number_of(a), number_b = number_of(b);
  if (number_a && number_b) return *number_a == *number_b;
  if (a.index() != b.index()) return false;
  if (const auto* text = std::get_if<std::string>(&a)) return *text == std::get<std::string>(b);
  if (const auto* flag = std::get_if<bool>(&a)) return *flag == std::get<bool>(b);
  return true;  // neither of the two has a default
}

bool is_same_declaration(const ScriptParameter& a, const ScriptParameter& b) {
  return is_same_value(a.initial, b.initial) && a.min == b.min && a.max == b.max && a.step == b.step && a.unit_value == b.unit_value;
}

/// Returns true if the source has `require` of a module that exists and is not loaded yet.
bool has_unloaded_module(const ScriptSession& session, const std::string& source) {
  for (std::size_t at = find_word(source, 0, "require"); at != std::string::npos; at = find_word(source, at + 1, "require")) {
    const std::size_t quote = source.find_first_of("\"'", at);
    if (quote == std::string::npos) continue;
    const std::string name = source.substr(quote + 1, source.find(source[quote], quote + 1) - quote - 1);
    if (!session.series.modules.contains(name) && std::filesystem::exists(session.script.parent_path() / (name + ".lua"))) return true;
  }
  return false;
}

bool has_args_to_come(const DeclaredArguments& declared, const std::string& file, const std::string& source) {
  return std::ranges::any_of(table_calls(source, "args"), [&](const TableCall& call) {
    return !declared.calls.contains(file + ":" + std::to_string(line_of(source, call.word))) &&
           !declared.calls.contains(file + ":" + std::to_string(line_of(source, call.begin)));
  });
}

/// Returns true if a source reads args.NAME.
bool is_read_alone(const std::string& source, const std::string& name) {
  for (std::size_t at = find_word(source, 0, "args"); at != std::string::npos; at = find_word(source, at + 1, "args"))
    if (source.compare(at + 4, name.size() + 1, "." + name) == 0 && (at + 5 + name.size() >= source.size() || !is_word(source[at + 5 + name.size()])))
      return true;
  return false;
}

}  // namespace

std::vector<std::string> add_declared(ScriptSession& session, const std::string& where, std::vector<ScriptParameter> parameters) {
  DeclaredArguments& declared = session.declared;
  const std::string location = location_of(where);
  declared.calls.insert(location);
  sort_as_written(parameters, session, location);
  std::vector<std::string> problems;
  for (ScriptParameter& parameter : parameters) {
    const auto before = std::ranges::find(declared.list, parameter.name, &ScriptParameter::name);
    if (before == declared.list.end()) {
      declared.locations[parameter.name] = location;
      declared.list.push_back(std::move(parameter));
    } else if (!is_same_declaration(*before, parameter)) {
      problems.push_back("argument " + parameter.name + ": " + declared.locations[parameter.name] +
                         " declares it with another default or other limits; declare it once, or identically in both places");
    }
  }
  return problems;
}

std::vector<std::string> unknown_arguments(const ScriptSession& session, bool is_over) {
  const DeclaredArguments& declared = session.declared;
  if (declared.calls.empty()) return {};
  const auto sources = sources_of(session);
  if (!is_over && std::ranges::any_of(sources, [&](const auto& source) {
        return has_unloaded_module(session, *source.second) || has_args_to_come(declared, source.first, *source.second);
      }))
    return {};
  std::vector<std::string> known, problems;
  for (const ScriptParameter& parameter : declared.list) known.push_back(parameter.name);
  for (const auto& [name, text] : session.arguments) {
    if (std::ranges::find(known, name) != known.end()) continue;
    if (std::ranges::any_of(sources, [&name = name](const auto& source) { return is_read_alone(*source.second, name); })) continue;
    const std::string nearest = nearest_name(name, known);
    problems.push_back("this script has no argument " + name + (nearest.empty() ? "" : ", did you mean " + nearest + "?"));
  }
  return problems;
}

void refuse_unknown_arguments(ScriptSession& session, bool is_over) {
  if (session.arguments.empty() || session.declared.is_refused) return;
  const std::vector<std::string> problems = unknown_arguments(session, is_over);
  if (problems.empty()) return;
  session.declared.is_refused = true;
  if (session.watch) session.watch->declared(session.declared.list, true);
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "; ") + problem;
  throw Error({.code = ErrorCode::bad_argument, .attempted = "arguments of " + session.script.string(), .problem = text});
}

}  // namespace sterna::scripting
