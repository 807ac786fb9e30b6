// Limits shared by readers and writers of text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

namespace sterna::io {

inline constexpr std::size_t k_stop_interval = 1 << 16;  ///< items between two checks of the stop token
inline constexpr std::size_t k_longest_number = 1000;    ///< characters of a number
inline constexpr std::uint64_t k_max_int32 = std::numeric_limits<std::int32_t>::max();

}  // namespace sterna::io
