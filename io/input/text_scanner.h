// Strict tokenizer for text formats over a loaded file: numbers by from_chars, any kind of line end. Errors state the line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "geom/base/borrowed.h"
#include "io/input/file_buffer.h"

namespace sterna::io {

/// Tokens are separated by blanks and line ends (\n, \r\n or \r). A UTF-8 byte order mark at the beginning is skipped.
/// Functions with `expected` ("the number of vertices") throw Error(file_malformed) with the line, the token found and the expectation.
class TextScanner {
 public:
  struct Rules {
    char comment = '\0';       ///< starts a comment to the end of the line; '\0' = none
    char continuation = '\0';  ///< before a line end: the line continues; '\0' = none
    bool line_bound = false;   ///< token(), real(), integer() never cross a line end
  };
  explicit TextScanner(Borrowed<const FileBuffer> buffer) : TextScanner(buffer, Rules{}) {}
  TextScanner(Borrowed<const FileBuffer> buffer, Rules rules);

  void set_line_bound(bool value) { rules_.line_bound = value; }

  /// Skips blanks, comments and line ends. Returns true at the end of the text.
  bool at_end();
  /// Skips blanks and a comment. Returns true if the line has no further token.
  bool at_line_end();
  /// Moves to the beginning of the next line (to the end of the text after the last).
  void next_line();
  /// Returns the rest of the current line without surrounding blanks and without comment; moves to the next line.
  std::string_view rest_of_line();

  /// Returns the next token; never empty.
  std::string_view token(std::string_view expected);
  /// Returns the next token without consuming it; empty at the end of the text (of the line if line-bound).
  std::string_view peek();
  /// Skips one token.
  void skip_token(std::string_view expected) { token(expected); }
  /// Reads a finite number. Values too small for a double become zero.
  double real(std::string_view expected);
  /// Reads a number like real(), but accepts numbers that are not finite: nan, inf, 1e999, 1.#QNAN, -1.#IND.
  double coordinate(std::string_view expected);
  std::int64_t integer(std::string_view expected);
  /// Reads a count of items, an integer in [0, remaining bytes / min_bytes]. Each item takes at least `min_bytes` of the remaining text, so that memory
  /// reserved for the items is proportional to the file size.
  std::size_t count(std::string_view expected, std::size_t min_bytes);
  /// Reads an integer in [base, base + n) and returns it less base.
  std::uint32_t index(std::string_view expected, std::int64_t base, std::size_t n);
  /// Consumes the token `word` (case-insensitive).
  void keyword(std::string_view word);

  /// Returns the line (from 1) of the byte at `offset`. Time is proportional to the offset, so use it for messages only.
  std::size_t line_at(std::size_t offset) const;
  std::size_t line() const { return line_at(token_begin_); }
  std::size_t offset() const { return position_; }
  /// Continues at that byte.
  /// \pre offset <= size of the file
  void seek(std::size_t offset) { position_ = token_begin_ = offset; }
  std::size_t remaining() const { return text_.size() - position_; }
  const std::string& source() const { return source_; }

  /// Throws Error(file_malformed) located at the last token read.
  [[noreturn]] void fail(std::string_view problem, std::string_view hint = {}) const;
  /// Throws as fail(), with "found ..., expected ...".
  [[noreturn]] void fail_expected(std::string_view expected) const;

 private:
  void skip_space(bool over_lines);
  bool is_token_end(std::size_t position) const;
  void begin_token(std::string_view expected);
  double any_real(std::string_view expected);
  std::size_t end_of_line(std::size_t position) const;

  std::string_view text_;
  std::string source_;
  Rules rules_;
  std::size_t position_ = 0;
  std::size_t token_begin_ = 0;
};

/// Returns true if the strings are equal except for the case of ASCII letters.
bool equal_ignoring_case(std::string_view a, std::string_view b);

}  // namespace sterna::io
