// Layer truncation on a wall: behaviour where the layer is too low for all requested layers (layer/truncate.h).
#pragma once

#include <cstdint>
#include <string_view>

namespace sterna::volmesh {

/// Ordered by how many layers growth lines give up.
enum class Truncation : std::uint8_t { never, automatic, always };
/// Returns the truncation named by \p text: "auto", "never" or "always", as PrismOptions::truncate. \throws Error(bad_argument) for any other string
Truncation truncation_of(std::string_view text);

}  // namespace sterna::volmesh
