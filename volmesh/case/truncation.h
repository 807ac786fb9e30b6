// What a wall may do where its layer is too low for all layers that were asked for (layer/truncate.h).
#pragma once

#include <cstdint>
#include <string_view>

namespace sterna::volmesh {

/// In the order in which lines give up more layers.
enum class Truncation : std::uint8_t { never, automatic, always };
/// \p text "auto", "never" or "always", as PrismOptions::truncate. \throws Error(bad_argument) for another
Truncation truncation_of(std::string_view text);

}  // namespace sterna::volmesh
