#include "scripting/series/script_essence.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

#include "scripting/lua/lua_text.h"

namespace sterna::scripting {
namespace {

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// Finds the ranges {begin, end} of the entries `run` and `retry` of the table, each with its trailing separator.
void find_entries(const std::string& s, const TableCall& table, std::vector<std::pair<std::size_t, std::size_t>>& found) {
  constexpr std::array<std::string_view, 2> k_names = {"run", "retry"};
  int depth = 0;
  std::size_t begin = std::string::npos;  // start of the entry that is left out
  bool is_first = true;                   // there were only blanks since the last separator
  look_through(s, table.begin, [&](std::size_t at) {
    const char c = s[at];
    if (at >= table.end || (depth == 0 && (c == ',' || c == ';'))) {
      if (begin != std::string::npos) found.emplace_back(begin, at >= table.end ? at : at + 1);
      begin = std::string::npos;
      is_first = true;
      return at >= table.end;
    }
    if (depth == 0 && is_first && !is_blank(c)) {
      is_first = false;
      for (const std::string_view name : k_names) {
        std::size_t equals = at + name.size();
        while (equals < s.size() && is_blank(s[equals])) ++equals;
        if (s.compare(at, name.size(), name) == 0 && equals + 1 < s.size() && s[equals] == '=' && s[equals + 1] != '=') begin = at;
      }
    }
    if (c == '{' || c == '(' || c == '[') ++depth;
    if (c == '}' || c == ')' || c == ']') --depth;
    return false;
  });
}

}  // namespace

std::string script_essence(const std::string& script) {
  std::vector<std::pair<std::size_t, std::size_t>> left_out;
  for (const TableCall& table : table_calls(script, "series"))
    if (table.end != std::string::npos) find_entries(script, table, left_out);
  std::string essence;
  const auto add_blank = [&] {
    if (!essence.empty() && essence.back() != ' ') essence += ' ';
  };
  for (std::size_t at = 0; at < script.size();) {
    const auto entry = std::ranges::find(left_out, at, &std::pair<std::size_t, std::size_t>::first);
    const std::size_t behind = behind_text(script, at);
    if (entry != left_out.end()) {
      at = std::max(entry->second, at + 1);
      add_blank();
    } else if (script.compare(at, 2, "--") == 0) {
      at = behind;
      add_blank();
    } else if (behind > at) {
      essence += script.substr(at, behind - at);
      at = behind;
    } else if (is_blank(script[at])) {
      ++at;
      add_blank();
    } else {
      // A separator before the end of a table has no effect.
      if (script[at] == '}') {
        while (!essence.empty() && essence.back() == ' ') essence.pop_back();
        if (!essence.empty() && (essence.back() == ',' || essence.back() == ';')) essence.pop_back();
        add_blank();
      }
      essence += script[at++];
    }
  }
  while (essence.ends_with(' ')) essence.pop_back();
  return essence;
}

}  // namespace sterna::scripting
