#include "io/grammar/foam_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>

#include "geom/base/error.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_longest_header_value = 200;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }
bool is_mark(char c) { return c == '(' || c == ')' || c == '{' || c == '}' || c == ';'; }

template <class T>
T take_bytes(const char* at, std::endian order) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), at, sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace

std::filesystem::path packed_or_plain(const std::filesystem::path& path) {
  const std::filesystem::path packed = path.string() + ".gz";
  std::error_code status;  // if the file cannot be accessed; opening it reports the error
  return !std::filesystem::exists(path, status) && std::filesystem::exists(packed, status) ? packed : path;
}

FoamFile::FoamFile(const std::filesystem::path& path, std::string_view object_class, const RunContext& context)
    : buffer_(load_file(packed_or_plain(path), context)), text_(buffer_.text()) {
  read_header(object_class);
}

void FoamFile::skip_space() {
  while (position_ < text_.size()) {
    const std::string_view rest = text_.substr(position_, 2);
    if (is_space(text_[position_])) {
      ++position_;
    } else if (rest == "//") {
      while (position_ < text_.size() && text_[position_] != '\n') ++position_;
    } else if (rest == "/*") {
      const std::size_t end = text_.find("*/", position_ + 2);
      position_ = end == std::string_view::npos ? text_.size() : end + 2;
    } else {
      return;
    }
  }
}

std::string_view FoamFile::peek() {
  skip_space();
  token_begin_ = position_;
  if (position_ == text_.size()) return {};
  if (is_mark(text_[position_])) return text_.substr(position_, 1);
  std::size_t end = position_;
  if (text_[position_] == '"') {
    end = text_.find('"', position_ + 1);
    if (end == std::string_view::npos) fail("found a string without its end");
    return text_.substr(position_, end + 1 - position_);
  }
  while (end < text_.size() && !is_space(text_[end]) && !is_mark(text_[end]) && text_[end] != '"') ++end;
  return text_.substr(position_, end - position_);
}

std::string_view FoamFile::token() {
  const std::string_view found = peek();
  position_ += found.size();
  if (found.size() >= 2 && found.front() == '"') return found.substr(1, found.size() - 2);
  return found;
}

void FoamFile::expect(std::string_view required) {
  const std::string_view found = token();
  if (found != required) fail("found " + (found.empty() ? "the end of the file" : quoted_excerpt(found)) + ", expected \"" + std::string(required) + "\"");
}

std::int64_t FoamFile::integer(std::string_view expected) {
  const std::string_view found = token();
  std::int64_t value = 0;
  const auto [end, failure] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (found.empty() || failure != std::errc{} || end != found.data() + found.size())
    fail("found " + (found.empty() ? "the end of the file" : quoted_excerpt(found)) + ", expected " + std::string(expected));
  return value;
}

double FoamFile::real(std::string_view expected) {
  const std::string_view found = token();
  double value = 0.0;
  const auto [end, failure] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (failure == std::errc::result_out_of_range && end == found.data() + found.size())
    value = std::strtod(std::string(found.substr(0, 64)).c_str(), nullptr);  // an underflow becomes zero
  else if (found.empty() || failure != std::errc{} || end != found.data() + found.size())
    fail("found " + (found.empty() ? "the end of the file" : quoted_excerpt(found)) + ", expected " + std::string(expected));
  if (!std::isfinite(value)) fail("found " + quoted_excerpt(found) + ", expected " + std::string(expected) + " (a finite number)");
  return value;
}

std::uint64_t FoamFile::count(std::string_view expected, std::size_t min_bytes) {
  const std::int64_t n = integer(expected);
  const std::size_t limit = (text_.size() - position_) / min_bytes;
  if (n < 0 || static_cast<std::uint64_t>(n) > limit)
    fail("found " + std::to_string(n) + " as " + std::string(expected) + ", but the " + std::to_string(text_.size() - position_) +
         " bytes left in the file hold at most " + std::to_string(limit));
  return static_cast<std::uint64_t>(n);
}

void FoamFile::read_header(std::string_view object_class) {
  expect("FoamFile");
  expect("{");
  for (std::string_view key = token(); key != "}"; key = token()) {
    if (key.empty()) fail("found the end of the file, expected \"}\" behind the header");
    std::string value;
    for (std::string_view word = token(); word != ";"; word = token()) {
      if (word.empty() || value.size() > k_longest_header_value) fail("found no \";\" behind the header's " + quoted_excerpt(key));
      value += word;
    }
    if (key == "format") {
      if (value != "ascii" && value != "binary") fail("found the format " + quoted_excerpt(value) + ", expected ascii or binary");
      is_binary_ = value == "binary";
    } else if (key == "arch") {
      read_arch(value);
    } else if (key == "class") {
      class_ = value;
    }
  }
  if (class_.empty() || (" " + std::string(object_class) + " ").find(" " + class_ + " ") == std::string::npos)
    fail("found the class " + quoted_excerpt(class_) + ", expected " + std::string(object_class));
}

/// Reads "LSB;label=32;scalar=64".
void FoamFile::read_arch(std::string_view arch) {
  if (arch.find("MSB") != std::string_view::npos) order_ = std::endian::big;
  if (arch.find("label=64") != std::string_view::npos) label_size_ = 8;
  if (arch.find("scalar=32") != std::string_view::npos) scalar_size_ = 4;
}

void FoamFile::begin_bytes(std::uint64_t n, std::size_t size, std::string_view expected) {
  expect("(");
  if (n > (text_.size() - position_) / size)
    throw_malformed(buffer_.source, "byte " + std::to_string(position_),
                    "found " + std::to_string(text_.size() - position_) + " bytes to the end of the file, expected " + std::to_string(n) + " times " +
                        std::to_string(size) + " bytes: " + std::string(expected),
                    "the file may have been cut short: copy or write it again");
}

void FoamFile::end_bytes() {
  if (position_ >= text_.size() || text_[position_] != ')')
    throw_malformed(buffer_.source, "byte " + std::to_string(position_), "found no \")\" behind the list",
                    "the size of labels or scalars may differ from the size in the header");
  ++position_;
}

std::int64_t FoamFile::take_label() {
  const char* const at = text_.data() + position_;
  position_ += label_size_;
  return label_size_ == 8 ? take_bytes<std::int64_t>(at, order_) : take_bytes<std::int32_t>(at, order_);
}

double FoamFile::take_scalar() {
  const char* const at = text_.data() + position_;
  position_ += scalar_size_;
  const double value = scalar_size_ == 8 ? take_bytes<double>(at, order_) : static_cast<double>(take_bytes<float>(at, order_));
  if (!std::isfinite(value)) throw_malformed(buffer_.source, "byte " + std::to_string(position_ - scalar_size_), "found a number that is not finite");
  return value;
}

std::uint32_t FoamFile::checked(std::int64_t label, std::string_view expected, std::uint64_t limit) const {
  if (label < 0 || static_cast<std::uint64_t>(label) >= limit) {
    const std::string problem =
        "found " + std::to_string(label) + " as " + std::string(expected) + ", expected 0 to " + std::to_string(static_cast<std::int64_t>(limit) - 1);
    if (is_binary_) throw_malformed(buffer_.source, "byte " + std::to_string(position_), problem);
    fail(problem);
  }
  return static_cast<std::uint32_t>(label);
}

std::vector<std::uint32_t> FoamFile::labels(std::string_view expected, std::uint64_t limit, std::uint64_t label_limit) {
  const std::int64_t announced = integer("the number of entries");
  if (announced < 0 || static_cast<std::uint64_t>(announced) > limit)
    fail("found " + std::to_string(announced) + " entries, expected at most " + std::to_string(limit));
  const auto n = static_cast<std::uint64_t>(announced);
  if (n == 0) {
    if (peek() == "(") {
      expect("(");
      expect(")");
    }
    return {};
  }
  if (!is_binary_ && peek() == "{") {  // uniform list
    expect("{");
    const std::uint32_t value = checked(integer(expected), expected, label_limit);
    expect("}");
    return std::vector<std::uint32_t>(n, value);
  }
  std::vector<std::uint32_t> values;
  if (is_binary_) {
    begin_bytes(n, label_size_, expected);
    values.resize(n);
    for (std::uint32_t& value : values) value = checked(take_label(), expected, label_limit);
    end_bytes();
    return values;
  }
  expect("(");
  if (n > (text_.size() - position_) / 2) fail("found " + std::to_string(n) + " entries announced, more than the rest of the file can hold");
  values.resize(n);
  for (std::uint32_t& value : values) value = checked(integer(expected), expected, label_limit);
  expect(")");
  return values;
}

std::vector<Vec3> FoamFile::vectors(std::string_view expected) {
  const std::uint64_t n = count("the number of points", is_binary_ ? 3 * scalar_size_ : 7);
  std::vector<Vec3> values(n);
  if (is_binary_) {
    if (n == 0) return values;
    begin_bytes(n, 3 * scalar_size_, expected);
    for (Vec3& p : values)
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = take_scalar();
    end_bytes();
    return values;
  }
  expect("(");
  for (Vec3& p : values) {
    expect("(");
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = real(expected);
    expect(")");
  }
  expect(")");
  return values;
}

void FoamFile::label_lists(std::string_view expected, std::uint64_t label_limit, std::vector<std::uint32_t>& values, std::vector<std::uint64_t>& first) {
  const std::uint64_t n = count("the number of faces", 3);
  first.assign(1, 0);
  first.reserve(n + 1);
  expect("(");
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::uint64_t size = count("the number of nodes of a face", 2);
    if (is_binary_) begin_bytes(size, label_size_, expected);
    else expect("(");
    for (std::uint64_t k = 0; k < size; ++k) values.push_back(checked(is_binary_ ? take_label() : integer(expected), expected, label_limit));
    if (is_binary_) end_bytes();
    else expect(")");
    first.push_back(values.size());
  }
  expect(")");
}

void FoamFile::compact_label_lists(std::string_view expected, std::uint64_t label_limit, std::vector<std::uint32_t>& values,
                                   std::vector<std::uint64_t>& first) {
  constexpr std::uint64_t k_any = 0xffffffff;  // offsets of compact lists are labels
  const std::uint64_t limit = text_.size();    // an entry takes at least one byte
  const std::vector<std::uint32_t> offsets = labels("the offset of the first node of a face", limit, k_any);
  values = labels(expected, limit, label_limit);
  first.assign(offsets.begin(), offsets.end());
  if (first.empty()) first.push_back(0);
  if (first.front() != 0 || first.back() != values.size() || !std::is_sorted(first.begin(), first.end()))
    fail("the offsets of the face nodes do not ascend from 0 to " + std::to_string(values.size()) + ", the number of nodes");
}

void FoamFile::fail(const std::string& problem) const {
  const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(std::min(token_begin_, text_.size())), '\n');
  throw_malformed(buffer_.source, "line " + std::to_string(line), problem);
}

}  // namespace sterna::io
