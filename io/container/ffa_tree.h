// FFA data sets, the container of FOI Edge (docs/method/formats_solvers.md, "FFA container"): a tree of named nodes with numbers or strings, binary (version 1
// and 2) or text.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/borrowed.h"
#include "io/input/file_buffer.h"

namespace sterna::io {

/// A node of an FFA tree. Values are decoded on access.
class FfaNode {
 public:
  std::string name;
  char type = 'N';  ///< I, J, R, D numbers; S, L strings; N none
  std::uint64_t n_columns = 0;
  std::uint64_t n_rows = 0;
  std::vector<FfaNode> children;

  std::uint64_t n_values() const { return n_columns * n_rows; }
  bool is_integer() const { return type == 'I' || type == 'J'; }
  bool is_real() const { return type == 'R' || type == 'D'; }
  bool is_text() const { return type == 'S' || type == 'L'; }
  /// Returns an integer value.
  /// \pre is_integer(); row, column in range
  std::int64_t integer(std::uint64_t row, std::uint64_t column) const;
  /// Returns an integer or real value; may not be finite.
  /// \pre is_real() or is_integer()
  double real(std::uint64_t row, std::uint64_t column) const;
  /// Returns the first string without trailing blanks.
  /// \pre is_text() and n_values() > 0
  std::string text() const;

  /// Returns the first child of that name, or nullptr.
  const FfaNode* find(std::string_view child) const;
  /// Returns the first child of that name.
  /// \throws Error(file_malformed) if there is none
  const FfaNode& at(std::string_view child) const;
  /// Returns the location for messages: "byte 120" or "line 7".
  std::string location() const;
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  friend class FfaParser;
  std::uint64_t location_of(std::uint64_t row, std::uint64_t column) const { return column * n_rows + row; }

  const FileBuffer* buffer_ = nullptr;
  std::size_t begin_ = 0;  ///< offset of the node, for messages
  std::size_t data_ = 0;   ///< first byte of the values
  std::endian order_ = std::endian::big;
  bool is_ascii_ = false;
  std::vector<double> reals_;           ///< only for text files
  std::vector<std::int64_t> integers_;  ///< only for text files
  std::string text_;                    ///< only for text files
};

/// Reads the tree; binary version or text is detected from the content.
/// \throws Error file_malformed, unsupported_format (records of 2 GiB and more in version 1)
FfaNode parse_ffa(Borrowed<const FileBuffer> buffer);

/// Returns the number of bytes of one value of type `type`.
std::size_t ffa_value_size(char type);

}  // namespace sterna::io
