// An array of numbers as a container file (HDF5, ADF, NetCDF) holds it: type, byte order, extents, bytes; converted number by number.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/input/number_kind.h"

namespace sterna::io {

/// The product of extents.
/// \throws Error(file_malformed), speaking of `where` in `source`, when it does not fit 64 bits.
std::uint64_t count_of(const std::vector<std::uint64_t>& extents, const std::string& source, const std::string& where);

/// A view of the values; whoever has them (ContainerImage) must outlive it. bytes.size() == count() * byte_size(kind).
struct NumberArray {
  NumberKind kind = NumberKind::i4;
  std::endian order = std::endian::little;
  std::vector<std::uint64_t> extents;  ///< slowest first, as in C
  std::string_view bytes;
  std::string source;  ///< the file, for messages
  std::string where;   ///< a path of names

  std::uint64_t count() const { return bytes.size() / byte_size(kind); }
  /// \pre is_integer(kind), i < count(). Unsigned numbers beyond 2^63 come out negative, which every range check refuses.
  std::int64_t integer(std::uint64_t i) const;
  /// Of any kind of number.
  /// \pre i < count()
  double real(std::uint64_t i) const;
  /// Bytes up to the first NUL, trailing blanks cut.
  std::string text() const;

  /// Throws Error(file_malformed) unless the numbers are integers (reals) and n of them. \param what "the corners of the faces"
  void require_integers(std::uint64_t n, std::string_view what) const;
  void require_reals(std::uint64_t n, std::string_view what) const;
  [[noreturn]] void fail(std::string_view problem) const;
};

}  // namespace sterna::io
