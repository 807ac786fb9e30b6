// Functions for Lua source as text, which find the parts outside of comments and strings.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sterna::scripting {

/// Returns true if the character can be part of a name.
bool is_word(char c);

/// Returns the position after a comment or a string that begins at `at`; `at` itself if none begins there.
std::size_t behind_text(const std::string& text, std::size_t at);

/// Calls f(position) for each character outside of comments and strings from `from` on, and for the first character of each string, until f returns true.
/// Returns the position where f returned true; npos otherwise.
template <class F>
std::size_t look_through(const std::string& text, std::size_t from, const F& f) {
  for (std::size_t at = from; at < text.size();) {
    if (text.compare(at, 2, "--") != 0 && f(at)) return at;
    const std::size_t next = behind_text(text, at);
    at = next == at ? at + 1 : next;
  }
  return std::string::npos;
}

/// A call `name{ ... }` or `name({ ... })`.
struct TableCall {
  std::size_t word;   ///< position of the name
  std::size_t begin;  ///< after the brace
  std::size_t end;    ///< position of the closing brace; npos if it is missing
};

/// Returns all calls of that name with a table, in their order.
std::vector<TableCall> table_calls(const std::string& text, std::string_view name);

/// Returns the position of `name` as a whole word outside of comments and strings, from `from` on; npos if there is none.
std::size_t find_word(const std::string& text, std::size_t from, std::string_view name);

/// Returns the number of the line, from 1.
std::size_t line_of(const std::string& text, std::size_t at);

}  // namespace sterna::scripting
