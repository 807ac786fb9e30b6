// An array of numbers as a container file (HDF5, ADF, NetCDF) holds it: type, byte order, extents, bytes; converted number by number.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace sterna::io {

enum class NumberKind : std::uint8_t { i1, u1, i2, u2, i4, u4, i8, u8, f4, f8, text };
std::size_t byte_size(NumberKind kind);
constexpr bool is_real(NumberKind kind) { return kind == NumberKind::f4 || kind == NumberKind::f8; }
constexpr bool is_integer(NumberKind kind) { return kind < NumberKind::f4; }

/// The product of extents. \throws Error(file_malformed), speaking of `where` in `source`, when it does not fit 64 bits.
std::uint64_t count_of(const std::vector<std::uint64_t>& extents, const std::string& source, const std::string& where);

/// A view of the file's bytes, or of `unpacked` where they were packed or in pieces. bytes.size() == count() * byte_size(kind).
struct NumberArray {
  NumberKind kind = NumberKind::i4;
  std::endian order = std::endian::little;
  std::vector<std::uint64_t> extents;  ///< slowest first, as in C
  std::string_view bytes;
  std::shared_ptr<const std::vector<char>> unpacked;
  std::string source;  ///< the file, for messages
  std::string where;   ///< "byte 2048" or a path of names

  std::uint64_t count() const { return bytes.size() / byte_size(kind); }
  /// \pre is_integer(kind), i < count(). Unsigned numbers beyond 2^63 come out negative, which every range check refuses.
  std::int64_t integer(std::uint64_t i) const;
  /// Of any kind of number. \pre i < count()
  double real(std::uint64_t i) const;
  /// Bytes up to the first NUL, trailing blanks cut.
  std::string text() const;

  /// Throws Error(file_malformed) unless the numbers are integers (reals) and n of them. \param what "the corners of the faces"
  void require_integers(std::uint64_t n, std::string_view what) const;
  void require_reals(std::uint64_t n, std::string_view what) const;
  [[noreturn]] void fail(std::string_view problem) const;
};

}  // namespace sterna::io
