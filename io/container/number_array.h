// An array of numbers as stored in a container file (HDF5, ADF, NetCDF): type, byte order, extents, bytes. Numbers are converted on access.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/input/number_kind.h"

namespace sterna::io {

/// Returns the product of the extents.
/// \throws Error(file_malformed), naming `where` in `source`, if the product does not fit 64 bits.
std::uint64_t count_of(const std::vector<std::uint64_t>& extents, const std::string& source, const std::string& where);

/// A view of the values, whose owner (ContainerImage) must outlive it. bytes.size() == count() * byte_size(kind).
struct NumberArray {
  NumberKind kind = NumberKind::i4;
  std::endian order = std::endian::little;
  std::vector<std::uint64_t> extents;  ///< slowest first, as in C
  std::string_view bytes;
  std::string source;  ///< the file, for messages
  std::string where;   ///< a path of names

  std::uint64_t count() const { return bytes.size() / byte_size(kind); }
  /// Returns an integer. Unsigned numbers beyond 2^63 become negative, which every range check rejects.
  /// \pre is_integer(kind), i < count()
  std::int64_t integer(std::uint64_t i) const;
  /// Returns a number of any kind.
  /// \pre i < count()
  double real(std::uint64_t i) const;
  /// Returns the bytes up to the first NUL, without trailing blanks.
  std::string text() const;

  /// Throws Error(file_malformed) unless there are n numbers and they are integers (reals). \param what "the corners of the faces"
  void require_integers(std::uint64_t n, std::string_view what) const;
  void require_reals(std::uint64_t n, std::string_view what) const;
  [[noreturn]] void fail(std::string_view problem) const;
};

}  // namespace sterna::io
