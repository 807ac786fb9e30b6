#include "scripting/view/script_defaults.h"

#include <cctype>
#include <optional>

#include "geom/base/error.h"
#include "scripting/lua/lua_text.h"

namespace sterna::scripting {
namespace {

[[noreturn]] void refuse_default(const std::string& problem) {
  throw Error({.code = ErrorCode::bad_argument, .attempted = "writing values into the script", .problem = problem, .hint = "edit the script manually"});
}

/// Returns the start of the value of `name` in the table of this args{}.
std::optional<std::size_t> find_value(const std::string& s, std::size_t begin, std::size_t end, const std::string& name) {
  const auto skip_blanks = [&](std::size_t at) {
    while (at < end && std::isspace(static_cast<unsigned char>(s[at])) != 0) ++at;
    return at;
  };
  int depth = 0;
  std::size_t value = std::string::npos;
  look_through(s, begin, [&](std::size_t at) {
    if (at >= end) return true;
    if (s[at] == '{') ++depth;
    if (s[at] == '}') --depth;
    if (depth != 0 || s.compare(at, name.size(), name) != 0 || (at > 0 && is_word(s[at - 1])) || is_word(s[at + name.size()])) return false;
    const std::size_t equals = skip_blanks(at + name.size());
    if (s[equals] != '=' || s[equals + 1] == '=') return false;
    value = skip_blanks(equals + 1);
    return true;
  });
  return value == std::string::npos ? std::nullopt : std::optional(value);
}

/// Returns the range {from, to} of the default of `name`. Script and modules may have several args{}, of which one must contain it.
std::pair<std::size_t, std::size_t> find_default(const std::string& s, const std::string& name) {
  const std::vector<TableCall> tables = table_calls(s, "args");
  if (tables.empty()) refuse_default("the script has no args{ ... }");
  const TableCall* table = nullptr;
  std::size_t value = 0;
  for (const TableCall& one : tables) {
    if (one.end == std::string::npos) refuse_default("args{ of the script is not closed");
    const std::optional<std::size_t> found = find_value(s, one.begin, one.end, name);
    if (!found) continue;
    if (table) refuse_default("the script declares " + name + " twice");
    table = &one;
    value = *found;
  }
  if (!table) refuse_default("args{} of this file has no default for " + name);
  const std::size_t end = table->end;
  const auto skip_blanks = [&](std::size_t at) {
    while (at < end && std::isspace(static_cast<unsigned char>(s[at])) != 0) ++at;
    return at;
  };
  if (s.compare(value, 6, "number") == 0 && !is_word(s[value + 6])) {
    const std::size_t brace = skip_blanks(value + 6);
    if (s[brace] != '{') refuse_default("the default of " + name + " is not a plain value");
    value = skip_blanks(brace + 1);
  }
  std::size_t to = look_through(s, value, [&](std::size_t at) { return at >= end || s[at] == ',' || s[at] == ';' || s[at] == '}'; });
  while (to > value && std::isspace(static_cast<unsigned char>(s[to - 1])) != 0) --to;
  return {value, to};
}

/// Returns true if a default can be replaced: a number, optionally followed by a unit; true, false; a string.
bool is_plain_default(std::string_view text) {
  if (text == "true" || text == "false") return true;
  if (text.size() > 1 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front())
    return text.substr(1, text.size() - 2).find(text.front()) == std::string_view::npos;
  std::size_t at = 0;
  while (at < text.size() && (std::isdigit(static_cast<unsigned char>(text[at])) != 0 || text[at] == '.' || text[at] == '-' || text[at] == '+' ||
                              ((text[at] == 'e' || text[at] == 'E') && at > 0)))
    ++at;
  if (at == 0) return false;
  while (at < text.size() && (text[at] == '*' || text[at] == ' ' || std::isalpha(static_cast<unsigned char>(text[at])) != 0)) ++at;
  return at == text.size();
}

/// Returns a value as Lua code that replaces this default.
std::string lua_value(const std::string& value, std::string_view before, const std::string& name) {
  if (before.front() == '"' || before.front() == '\'') {
    if (value.find_first_of("\"\\\n\r") != std::string::npos) refuse_default("the text for " + name + " has quotes or line ends");
    return '"' + value + '"';
  }
  if (!is_plain_default(value) || value.front() == '"' || value.front() == '\'') refuse_default("\"" + value + "\" is not a value for " + name);
  // 12deg on the command line is 12*deg in Lua.
  const std::size_t unit = value.find_last_of("0123456789.") + 1;
  return unit == 0 || unit == value.size() || value[unit] == '*' ? value : value.substr(0, unit) + "*" + value.substr(unit);
}

}  // namespace

std::string with_defaults(const std::string& script, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string text = script;
  for (const auto& [name, value] : values) {
    const auto [from, to] = find_default(text, name);
    const std::string before = text.substr(from, to - from);
    if (value.empty() || !is_plain_default(before)) refuse_default("the default of " + name + " is \"" + before + "\", which is computed");
    text.replace(from, to - from, lua_value(value, before, name));
  }
  return text;
}

}  // namespace sterna::scripting
