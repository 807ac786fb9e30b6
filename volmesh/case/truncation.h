// Layer truncation on a wall: what happens where the layer is too low for all requested layers (layer/truncate.h).
#pragma once

#include <cstdint>
#include <string_view>

namespace sterna::volmesh {

/// The values are in ascending order of the number of layers that growth lines lose.
enum class Truncation : std::uint8_t { never, automatic, always };
/// Returns the truncation named by \p text: "auto", "never" or "always", the values of PrismOptions::truncate. \throws Error(bad_argument) for any other string
Truncation truncation_of(std::string_view text);

}  // namespace sterna::volmesh
