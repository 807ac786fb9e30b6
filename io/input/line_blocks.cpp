#include "io/input/line_blocks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "io/input/text_limits.h"

namespace sterna::io {
namespace {

/// Lines per chunk: about 300 kB of text, long compared with the overhead of a task and short compared with the file.
constexpr std::uint64_t k_lines_per_chunk = 8192;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
bool ends_field(char c) { return is_blank(c) || c == '\n' || c == ','; }

}  // namespace

bool LineCursor::find_content() {
  while (at_ != end_) {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    if (at_ == end_) return false;
    if (*at_ != '\n' && *at_ != '%') return true;
    next_line();
  }
  return false;
}

void LineCursor::next_line() {
  const void* const newline = at_ == end_ ? nullptr : std::memchr(at_, '\n', static_cast<std::size_t>(end_ - at_));
  at_ = newline ? static_cast<const char*>(newline) + 1 : end_;
  ++line_;
}

std::string_view LineCursor::rest_of_line() const {
  const char* end = std::find(at_, end_, '\n');
  while (end != at_ && is_blank(end[-1])) --end;
  return {at_, static_cast<std::size_t>(end - at_)};
}

double LineCursor::real(const char* expected, std::uint64_t number) {
  skip_blanks();
  const char* const first = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
  double value = 0.0;
  const std::from_chars_result result = std::from_chars(first, end_, value);
  if (result.ec == std::errc{} && (result.ptr == end_ || ends_field(*result.ptr)) && std::isfinite(value)) {
    at_ = result.ptr;
    return value;
  }
  // Handles numbers that from_chars rejects: values below the smallest double, and Fortran's exponent 1.0D-3.
  const char* const field_end = std::find_if(first, end_, ends_field);
  std::string spelling(first, std::min(static_cast<std::size_t>(field_end - first), k_longest_number));
  std::replace_if(
      spelling.begin(), spelling.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  const bool is_decimal = !spelling.empty() && spelling.find_first_not_of("+-.0123456789eE") == std::string::npos;
  char* parsed = nullptr;
  value = std::strtod(spelling.c_str(), &parsed);
  if (!is_decimal || *parsed != '\0' || !std::isfinite(value)) fail_expected(expected, number);
  at_ = field_end;
  return value;
}

double LineCursor::coordinate(const char* expected, std::uint64_t number) {
  skip_blanks();
  const char* const first = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
  const char* const field_end = std::find_if(first, end_, ends_field);
  double value = 0.0;
  const std::from_chars_result result = std::from_chars(first, field_end, value);
  const bool is_whole = result.ec != std::errc::invalid_argument && result.ptr == field_end;
  if (result.ec == std::errc::result_out_of_range && is_whole)
    value = std::strtod(std::string(first, std::min(static_cast<std::size_t>(field_end - first), k_longest_number)).c_str(), nullptr);
  if (!is_whole || std::isfinite(value)) return real(expected, number);
  at_ = field_end;
  return value;
}

std::uint64_t LineCursor::integer(const char* expected, std::uint64_t number) {
  skip_blanks();
  std::uint64_t value = 0;
  const std::from_chars_result result = std::from_chars(at_, end_, value);
  if (result.ec != std::errc{} || (result.ptr != end_ && !ends_field(*result.ptr))) fail_expected(expected, number);
  at_ = result.ptr;
  return value;
}

std::uint32_t LineCursor::index(std::uint64_t limit, const char* expected, std::uint64_t number) {
  const std::uint64_t value = integer(expected, number);
  if (value < limit) return static_cast<std::uint32_t>(value);
  fail("found " + std::to_string(value) + " as " + expected + std::to_string(number) + ", expected a number from 0 to " +
           std::to_string(limit == 0 ? 0 : limit - 1),
       value == limit ? "numbers start at 0 in this format" : "");
}

LineBlock LineCursor::take_block(std::uint64_t n, std::string_view keyword) {
  LineBlock block{.n_items = n, .line = line_, .chunks = {}};
  next_line();
  for (std::uint64_t i = 0; i < n; ++i) {
    if (!find_content())
      fail("found the end of the file after " + std::to_string(i) + " of the " + std::to_string(n) + " lines that " + std::string(keyword) + " in line " +
               std::to_string(block.line) + " announces",
           "the file may have been cut short: copy or write it again");
    if (is_letter(*at_) && rest_of_line().find('=') != std::string_view::npos)
      fail("found " + quoted_excerpt(rest_of_line()) + " after " + std::to_string(i) + " of the " + std::to_string(n) + " lines that " + std::string(keyword) +
           " in line " + std::to_string(block.line) + " announces");
    if (i % k_lines_per_chunk == 0) block.chunks.push_back({.begin = at_, .line = line_, .first_item = i, .n_items = std::min(k_lines_per_chunk, n - i)});
    next_line();
    block.chunks.back().end = at_;
  }
  return block;
}

void LineCursor::fail(std::string_view problem, std::string_view hint) const { throw_malformed(source_, "line " + std::to_string(line_), problem, hint); }

void LineCursor::fail_expected(const char* expected, std::uint64_t number) const {
  const std::string_view found = rest_of_line();
  fail("found " + (found.empty() ? std::string("the end of the line") : quoted_excerpt(found.substr(0, found.find_first_of(" \t,")))) + ", expected " +
       expected + std::to_string(number));
}

}  // namespace sterna::io
