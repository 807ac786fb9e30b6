// Concatenates arrays at compile time.
#pragma once

#include <array>
#include <tuple>

namespace sterna {

/// \pre arrays of one type, not all empty
template <class... Arrays>
constexpr auto joined(const Arrays&... arrays) {
  return std::apply([](const auto&... entries) { return std::array{entries...}; }, std::tuple_cat(arrays...));
}

}  // namespace sterna
