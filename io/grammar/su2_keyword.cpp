#include "io/grammar/su2_keyword.h"

#include <cctype>

namespace sterna::io {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

Su2Keyword split_su2_keyword(std::string_view line) {
  const std::size_t equals = line.find('=');
  const std::string_view key = trimmed(line.substr(0, equals));
  if (equals == std::string_view::npos || key.empty() || !std::isalpha(static_cast<unsigned char>(key[0]))) return {};
  return {key, trimmed(line.substr(equals + 1))};
}

std::uint64_t su2_count(const Su2Keyword& keyword, const LineCursor& cursor) {
  if (keyword.value.empty() || !std::isdigit(static_cast<unsigned char>(keyword.value[0])))
    cursor.fail("found " + quoted_excerpt(keyword.value) + ", expected a count after " + std::string(keyword.key) + "=");
  std::uint64_t n = 0;
  for (const char c : keyword.value) {
    if (!std::isdigit(static_cast<unsigned char>(c))) break;
    n = n * 10 + static_cast<std::uint64_t>(c - '0');
    if (n > std::uint64_t{1} << 40) cursor.fail("the count after " + std::string(keyword.key) + "= is larger than any mesh");
  }
  return n;
}

std::string su2_marker_name(std::string_view value) {
  std::string name;
  for (const char c : value)
    if (c != ' ' && c != '\t') name += c;
  return name;
}

}  // namespace sterna::io
