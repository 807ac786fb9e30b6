#include "io/input/text_scanner.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <system_error>

#include "io/input/text_limits.h"

namespace sterna::io {
namespace {

enum : unsigned char { k_other = 0, k_blank = 1, k_line_end = 2 };

constexpr std::array<unsigned char, 256> make_classes() {
  std::array<unsigned char, 256> classes{};
  for (const char c : {' ', '\t', '\v', '\f'}) classes[static_cast<unsigned char>(c)] = k_blank;
  for (const char c : {'\n', '\r'}) classes[static_cast<unsigned char>(c)] = k_line_end;
  return classes;
}
constexpr std::array<unsigned char, 256> k_classes = make_classes();

unsigned char class_of(char c) { return k_classes[static_cast<unsigned char>(c)]; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return lower(x) == lower(y); });
}

TextScanner::TextScanner(Borrowed<const FileBuffer> buffer, Rules rules) : text_(buffer->text()), source_(buffer->source), rules_(rules) {
  if (text_.starts_with("\xEF\xBB\xBF")) position_ = token_begin_ = 3;
}

void TextScanner::skip_space(bool over_lines) {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    const unsigned char kind = class_of(c);
    if (kind == k_blank || (kind == k_line_end && over_lines)) {
      ++position_;
    } else if (c == rules_.comment && c != '\0') {
      position_ = end_of_line(position_);
    } else if (c == rules_.continuation && c != '\0' && position_ + 1 < text_.size() && class_of(text_[position_ + 1]) == k_line_end) {
      ++position_;
      next_line();
    } else {
      return;
    }
  }
}

std::size_t TextScanner::end_of_line(std::size_t position) const {
  while (position < text_.size() && class_of(text_[position]) != k_line_end) ++position;
  return position;
}

bool TextScanner::is_token_end(std::size_t position) const {
  if (position >= text_.size()) return true;
  const char c = text_[position];
  return class_of(c) != k_other || (c == rules_.comment && c != '\0') ||
         (c == rules_.continuation && c != '\0' && position + 1 < text_.size() && class_of(text_[position + 1]) == k_line_end);
}

bool TextScanner::at_end() {
  skip_space(true);
  token_begin_ = position_;
  return position_ == text_.size();
}

bool TextScanner::at_line_end() {
  skip_space(false);
  token_begin_ = position_;
  return position_ == text_.size() || class_of(text_[position_]) == k_line_end;
}

void TextScanner::next_line() {
  position_ = end_of_line(position_);
  if (position_ < text_.size()) position_ += text_.substr(position_, 2) == "\r\n" ? 2 : 1;
}

std::string_view TextScanner::rest_of_line() {
  skip_space(false);
  token_begin_ = position_;
  std::size_t end = position_;
  while (end < text_.size() && class_of(text_[end]) != k_line_end && !(text_[end] == rules_.comment && rules_.comment != '\0')) ++end;
  std::size_t trimmed = end;
  while (trimmed > position_ && class_of(text_[trimmed - 1]) == k_blank) --trimmed;
  const std::string_view rest = text_.substr(position_, trimmed - position_);
  next_line();
  return rest;
}

void TextScanner::begin_token(std::string_view expected) {
  skip_space(!rules_.line_bound);
  token_begin_ = position_;
  if (position_ == text_.size() || class_of(text_[position_]) == k_line_end) fail_expected(expected);
}

std::string_view TextScanner::peek() {
  skip_space(!rules_.line_bound);
  token_begin_ = position_;
  std::size_t end = position_;
  while (!is_token_end(end)) ++end;
  return text_.substr(position_, end - position_);
}

std::string_view TextScanner::token(std::string_view expected) {
  begin_token(expected);
  std::size_t end = position_;
  while (!is_token_end(end)) ++end;
  const std::string_view found = text_.substr(position_, end - position_);
  position_ = end;
  return found;
}

double TextScanner::real(std::string_view expected) {
  const std::size_t before = position_;
  const double value = any_real(expected);
  if (std::isfinite(value)) return value;
  position_ = before;
  fail("found " + quoted_excerpt(peek()) + ", expected " + std::string(expected) + " (a finite number)");
}

double TextScanner::coordinate(std::string_view expected) {
  begin_token(expected);
  const std::size_t begin = position_ + (text_[position_] == '-' || text_[position_] == '+' ? 1 : 0);
  if (text_.substr(begin, 3) != "1.#") return any_real(expected);  // nan and inf as written by Microsoft's library; '#' begins no comment there
  while (position_ < text_.size() && class_of(text_[position_]) == k_other) ++position_;
  return std::numeric_limits<double>::quiet_NaN();
}

/// Reads a number of any value.
double TextScanner::any_real(std::string_view expected) {
  begin_token(expected);
  const char* const first = text_.data() + position_ + (text_[position_] == '+' ? 1 : 0);
  double value = 0.0;
  const std::from_chars_result result = std::from_chars(first, text_.data() + text_.size(), value);
  const std::size_t end = static_cast<std::size_t>(result.ptr - text_.data());
  if (result.ec == std::errc::invalid_argument || !is_token_end(end) || (first != text_.data() + position_ && *first == '-')) {
    if (result.ec != std::errc::invalid_argument && end < text_.size() && text_[end] == ',')
      fail("found " + quoted_excerpt(peek()) + ", expected " + std::string(expected), "write numbers with a decimal point, not a comma");
    fail_expected(expected);
  }
  if (result.ec == std::errc::result_out_of_range) {
    const std::string spelling(first, std::min(static_cast<std::size_t>(result.ptr - first), k_longest_number));
    value = std::strtod(spelling.c_str(), nullptr);  // from_chars does not distinguish 1e-999 (zero) from 1e+999 (an error)
  }
  position_ = end;
  return value;
}

std::int64_t TextScanner::integer(std::string_view expected) {
  begin_token(expected);
  const char* const first = text_.data() + position_ + (text_[position_] == '+' ? 1 : 0);
  std::int64_t value = 0;
  const std::from_chars_result result = std::from_chars(first, text_.data() + text_.size(), value);
  const std::size_t end = static_cast<std::size_t>(result.ptr - text_.data());
  if (result.ec != std::errc{} || !is_token_end(end) || (first != text_.data() + position_ && *first == '-')) fail_expected(expected);
  position_ = end;
  return value;
}

std::size_t TextScanner::count(std::string_view expected, std::size_t min_bytes) {
  const std::int64_t value = integer(expected);
  // The last line may lack its line end, so one extra byte is allowed.
  const std::size_t limit = (remaining() + 1) / std::max<std::size_t>(1, min_bytes);
  if (value < 0 || static_cast<std::uint64_t>(value) > limit)
    fail("found " + std::to_string(value) + " as " + std::string(expected) + ", but the " + std::to_string(remaining()) +
             " bytes left in the file hold at most " + std::to_string(limit),
         value < 0 ? "" : "the file may have been cut short: copy or write it again");
  return static_cast<std::size_t>(value);
}

std::uint32_t TextScanner::index(std::string_view expected, std::int64_t base, std::size_t n) {
  const std::int64_t value = integer(expected);
  if (value < base || static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(base) >= n)
    fail("found " + std::to_string(value) + " as " + std::string(expected) +
         (n == 0 ? ", but the file has no such items"
                 : ", expected " + std::to_string(base) + " to " + std::to_string(base + static_cast<std::int64_t>(n) - 1)));
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(base));
}

void TextScanner::keyword(std::string_view word) {
  if (!equal_ignoring_case(token("\"" + std::string(word) + "\""), word)) fail_expected("\"" + std::string(word) + "\"");
}

std::size_t TextScanner::line_at(std::size_t offset) const {
  std::size_t line = 1;
  for (std::size_t i = 0; i < std::min(offset, text_.size()); ++i)
    if (text_[i] == '\n' || (text_[i] == '\r' && !(i + 1 < text_.size() && text_[i + 1] == '\n'))) ++line;
  return line;
}

void TextScanner::fail(std::string_view problem, std::string_view hint) const {
  throw_malformed(source_, "line " + std::to_string(line_at(token_begin_)), problem, hint);
}

void TextScanner::fail_expected(std::string_view expected) const {
  std::string found;
  if (token_begin_ >= text_.size()) {
    found = "the end of the file";
  } else if (class_of(text_[token_begin_]) == k_line_end) {
    found = "the end of the line";
  } else {
    std::size_t end = token_begin_;
    while (!is_token_end(end)) ++end;
    found = quoted_excerpt(text_.substr(token_begin_, end - token_begin_));
  }
  fail("found " + found + ", expected " + std::string(expected));
}

}  // namespace sterna::io
