// Byte planes of number arrays: all first bytes, then all second bytes, and so on. Similar bytes become adjacent, which improves LZ4 compression.
#pragma once

#include <cstddef>

namespace sterna::io {

/// Writes planes[k * n + i] = values[i * size + k] for n values of `size` bytes.
/// \pre no overlap
void gather_planes(const char* values, std::size_t n, std::size_t size, char* planes);
/// Inverts gather_planes(): values[i * size + k] = planes[k * n + i].
/// \pre no overlap
void scatter_planes(const char* planes, std::size_t n, std::size_t size, char* values);

}  // namespace sterna::io
