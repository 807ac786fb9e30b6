// The bytes of numbers sorted by place: all first bytes, then all second bytes, and so on. What is alike comes together, so that LZ4 finds it.
#pragma once

#include <cstddef>

namespace sterna::io {

/// planes[k * n + i] = values[i * size + k] for n values of `size` bytes.
/// \pre no overlap
void gather_planes(const char* values, std::size_t n, std::size_t size, char* planes);
/// The inverse: values[i * size + k] = planes[k * n + i].
/// \pre no overlap
void scatter_planes(const char* planes, std::size_t n, std::size_t size, char* values);

}  // namespace sterna::io
