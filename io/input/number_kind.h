// Kinds of numbers in container files (HDF5, ADF, NetCDF). Includes nothing of sterna, because the helper process shares this header.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sterna::io {

enum class NumberKind : std::uint8_t { i1, u1, i2, u2, i4, u4, i8, u8, f4, f8, text };
inline constexpr std::size_t k_number_kinds = 11;

constexpr std::size_t byte_size(NumberKind kind) {
  constexpr std::array<std::size_t, k_number_kinds> k_sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8, 1};
  return k_sizes[static_cast<std::size_t>(kind)];
}
constexpr bool is_real(NumberKind kind) { return kind == NumberKind::f4 || kind == NumberKind::f8; }
constexpr bool is_integer(NumberKind kind) { return kind < NumberKind::f4; }

}  // namespace sterna::io
