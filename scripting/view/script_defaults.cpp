#include "scripting/view/script_defaults.h"

#include <cctype>
#include <optional>

#include "geom/base/error.h"

namespace sterna::scripting {
namespace {

[[noreturn]] void refuse_default(const std::string& problem) {
  throw Error({.code = ErrorCode::bad_argument, .attempted = "writing values into the script", .problem = problem, .hint = "change it by hand"});
}

bool is_word(char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; }

/// The place behind a comment or a string that begins at `at`; `at` itself where none does.
std::size_t behind_text(const std::string& s, std::size_t at) {
  const auto long_bracket = [&](std::size_t from) -> std::optional<std::size_t> {  // [[ ... ]], [==[ ... ]==]
    if (from >= s.size() || s[from] != '[') return std::nullopt;
    std::size_t level = 0;
    while (from + 1 + level < s.size() && s[from + 1 + level] == '=') ++level;
    if (from + 1 + level >= s.size() || s[from + 1 + level] != '[') return std::nullopt;
    const std::size_t end = s.find("]" + std::string(level, '=') + "]", from + level + 2);
    return end == std::string::npos ? s.size() : end + level + 2;
  };
  if (s.compare(at, 2, "--") == 0) {
    if (const auto end = long_bracket(at + 2)) return *end;
    const std::size_t end = s.find('\n', at);
    return end == std::string::npos ? s.size() : end + 1;
  }
  if (const auto end = long_bracket(at)) return *end;
  if (s[at] != '"' && s[at] != '\'') return at;
  std::size_t end = at + 1;
  while (end < s.size() && s[end] != s[at]) end += s[end] == '\\' ? 2 : 1;
  return std::min(end + 1, s.size());
}

/// Calls f(place) for each character outside of comments and strings from `from` on, and for each first one of a string, until it says true.
template <class F>
std::size_t look_through(const std::string& s, std::size_t from, const F& f) {
  for (std::size_t at = from; at < s.size();) {
    if (s.compare(at, 2, "--") != 0 && f(at)) return at;
    const std::size_t next = behind_text(s, at);
    at = next == at ? at + 1 : next;
  }
  return std::string::npos;
}

/// {place behind "args{", place of its "}"}
std::pair<std::size_t, std::size_t> find_arguments(const std::string& s) {
  std::size_t begin = std::string::npos;
  look_through(s, 0, [&](std::size_t at) {
    if (s.compare(at, 4, "args") != 0 || (at > 0 && is_word(s[at - 1]))) return false;
    std::size_t brace = at + 4;
    while (brace < s.size() && std::isspace(static_cast<unsigned char>(s[brace])) != 0) ++brace;
    if (brace >= s.size() || s[brace] != '{') return false;
    if (begin != std::string::npos) refuse_default("it has args{} twice");
    begin = brace + 1;
    return false;
  });
  if (begin == std::string::npos) refuse_default("it has no args{ ... }");
  int depth = 1;
  const std::size_t end = look_through(s, begin, [&](std::size_t at) {
    if (s[at] == '{') ++depth;
    if (s[at] == '}') --depth;
    return depth == 0;
  });
  if (end == std::string::npos) refuse_default("its args{ is not closed");
  return {begin, end};
}

/// Where the default of `name` stands: {from, to}.
std::pair<std::size_t, std::size_t> find_default(const std::string& s, std::size_t begin, std::size_t end, const std::string& name) {
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
  if (value == std::string::npos) refuse_default("args{} has no default for " + name);
  if (s.compare(value, 6, "number") == 0 && !is_word(s[value + 6])) {
    const std::size_t brace = skip_blanks(value + 6);
    if (s[brace] != '{') refuse_default("the default of " + name + " is no plain value");
    value = skip_blanks(brace + 1);
  }
  std::size_t to = look_through(s, value, [&](std::size_t at) { return at >= end || s[at] == ',' || s[at] == ';' || s[at] == '}'; });
  while (to > value && std::isspace(static_cast<unsigned char>(s[to - 1])) != 0) --to;
  return {value, to};
}

/// Whether a default is something that can be replaced: a number, maybe with a unit behind; true, false; a string.
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

/// A value as Lua writes it in the place of that default.
std::string lua_value(const std::string& value, std::string_view before, const std::string& name) {
  if (before.front() == '"' || before.front() == '\'') {
    if (value.find_first_of("\"\\\n\r") != std::string::npos) refuse_default("the text for " + name + " has quotes or line ends");
    return '"' + value + '"';
  }
  if (!is_plain_default(value) || value.front() == '"' || value.front() == '\'') refuse_default("\"" + value + "\" is no value for " + name);
  // 12deg of the command line is 12*deg in Lua.
  const std::size_t unit = value.find_last_of("0123456789.") + 1;
  return unit == 0 || unit == value.size() || value[unit] == '*' ? value : value.substr(0, unit) + "*" + value.substr(unit);
}

}  // namespace

std::string with_defaults(const std::string& script, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string text = script;
  for (const auto& [name, value] : values) {
    const auto [begin, end] = find_arguments(text);
    const auto [from, to] = find_default(text, begin, end, name);
    const std::string before = text.substr(from, to - from);
    if (value.empty() || !is_plain_default(before)) refuse_default("the default of " + name + " is \"" + before + "\", which is computed");
    text.replace(from, to - from, lua_value(value, before, name));
  }
  return text;
}

}  // namespace sterna::scripting
