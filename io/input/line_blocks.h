// Text files of blocks, in which a keyword announces n lines with one item each. A first pass finds the start of blocks and of their chunks of lines (as fast
// as memchr); then all threads parse the chunks. Blank lines and '%' comments are ignored; CRLF is accepted.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/input/file_buffer.h"

namespace sterna::io {

/// Consecutive items of a block.
struct LineChunk {
  const char* begin = nullptr;
  const char* end = nullptr;
  std::uint64_t line = 0;        ///< number of the line at `begin`, from 1
  std::uint64_t first_item = 0;  ///< number of the first item in the block
  std::uint64_t n_items = 0;
};

struct LineBlock {
  std::uint64_t n_items = 0;
  std::uint64_t line = 0;  ///< line of the keyword
  std::vector<LineChunk> chunks;
};

/// Iterates over the lines of a text, and over the fields of a line. Throws Error(file_malformed) with the line.
class LineCursor {
 public:
  LineCursor(std::string_view text, std::string_view source) : at_(text.data()), end_(at_ + text.size()), source_(source) {}
  LineCursor(const LineChunk& chunk, std::string_view source) : at_(chunk.begin), end_(chunk.end), line_(chunk.line), source_(source) {}

  /// Moves to the first field of the next line with content. At the beginning of the text or chunk, the current line counts as the next one. Returns false at
  /// the end of the text.
  bool find_content();
  /// Moves past the end of the current line.
  void next_line();
  std::uint64_t line() const { return line_; }
  const char* position() const { return at_; }
  /// Returns the text from the position to the end of the line, without trailing blanks.
  std::string_view rest_of_line() const;

  /// Reads a field of the current line; blanks or commas before it are skipped. \p expected: "coordinate of node 7"; `number` is appended to the text if given.
  double real(const char* expected, std::uint64_t number);
  /// Reads a number like real(), but accepts numbers that are not finite: nan, inf, 1e999.
  double coordinate(const char* expected, std::uint64_t number);
  std::uint64_t integer(const char* expected, std::uint64_t number);
  /// Reads an integer below `limit`.
  std::uint32_t index(std::uint64_t limit, const char* expected, std::uint64_t number);

  /// Takes the next n items, from the next line on, as a block.
  /// \pre the position is in the keyword's line
  LineBlock take_block(std::uint64_t n, std::string_view keyword);

  [[noreturn]] void fail(std::string_view problem, std::string_view hint = {}) const;

 private:
  void skip_blanks() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == ',')) ++at_;
  }
  [[noreturn]] void fail_expected(const char* expected, std::uint64_t number) const;

  const char* at_;
  const char* end_;
  std::uint64_t line_ = 1;
  std::string_view source_;
};

}  // namespace sterna::io
