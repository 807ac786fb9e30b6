// Strict reader of binary formats over a loaded file. It reads fixed-width numbers of either byte order. Errors state the byte offset.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "geom/base/borrowed.h"
#include "io/input/file_buffer.h"

namespace sterna::io {

/// Functions with `expected` throw Error(file_malformed) with the byte offset, the value found and the expectation.
class ByteReader {
 public:
  explicit ByteReader(Borrowed<const FileBuffer> buffer, std::endian order = std::endian::little, std::size_t offset = 0)
      : bytes_(buffer->text()), source_(buffer->source), order_(order), position_(std::min(offset, buffer->bytes.size())) {}

  std::size_t offset() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }
  std::endian order() const { return order_; }

  /// Checks that `n` items of `size` bytes each are left in the file. No overflow for any n.
  void require(std::uint64_t n, std::size_t size, std::string_view expected) const {
    if (size != 0 && n > remaining() / size)
      fail("found " + std::to_string(remaining()) + " bytes to the end of the file, expected " + std::to_string(n) + " times " + std::to_string(size) +
               " bytes: " + std::string(expected),
           "the file may have been cut short: copy or write it again");
  }

  template <class T>
  requires std::is_arithmetic_v<T> T read(std::string_view expected) {
    require(1, sizeof(T), expected);
    return take<T>();
  }

  /// Reads a number as read() does, but without the check; for use after require().
  /// \pre sizeof(T) bytes are left
  template <class T>
  requires std::is_arithmetic_v<T> T take() {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + position_, sizeof(T));
    if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
    position_ += sizeof(T);
    return std::bit_cast<T>(raw);
  }

  /// \pre n <= remaining()
  void skip(std::size_t n) { position_ += n; }

  [[noreturn]] void fail(std::string_view problem, std::string_view hint = {}) const {
    throw_malformed(source_, "byte " + std::to_string(position_), problem, hint);
  }

 private:
  std::string_view bytes_;
  std::string source_;
  std::endian order_;
  std::size_t position_;
};

}  // namespace sterna::io
