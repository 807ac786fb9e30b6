#include "scripting/lua/lua_text.h"

#include <algorithm>
#include <cctype>
#include <optional>

namespace sterna::scripting {

bool is_word(char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; }

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

std::size_t find_word(const std::string& text, std::size_t from, std::string_view name) {
  return look_through(text, from, [&](std::size_t at) {
    return text.compare(at, name.size(), name) == 0 && (at == 0 || !is_word(text[at - 1])) &&
           (at + name.size() >= text.size() || !is_word(text[at + name.size()]));
  });
}

std::vector<TableCall> table_calls(const std::string& text, std::string_view name) {
  std::vector<TableCall> calls;
  const auto skip_blanks = [&](std::size_t at) {
    while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) != 0) ++at;
    return at;
  };
  for (std::size_t word = find_word(text, 0, name); word != std::string::npos; word = find_word(text, word + name.size(), name)) {
    std::size_t brace = skip_blanks(word + name.size());
    if (brace < text.size() && text[brace] == '(') brace = skip_blanks(brace + 1);
    if (brace >= text.size() || text[brace] != '{') continue;
    int depth = 1;
    const std::size_t end = look_through(text, brace + 1, [&](std::size_t at) {
      depth += text[at] == '{' ? 1 : text[at] == '}' ? -1 : 0;
      return depth == 0;
    });
    calls.push_back({.word = word, .begin = brace + 1, .end = end});
  }
  return calls;
}

std::size_t line_of(const std::string& text, std::size_t at) {
  return 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size())), '\n'));
}

}  // namespace sterna::scripting
