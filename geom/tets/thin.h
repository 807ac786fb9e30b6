// Of places that are too near to each other, one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/tets/bulk_insert.h"

namespace sterna::tets {

/// Indices of seeds, in the order given, none nearer to one before it in the list than its own `room.to_points`; as far as both distances have the same
/// exponent of two, what is left over is found at insertion. Serial, O(n), 0.3 us each.
std::vector<std::uint32_t> thinned(std::span<const Seed> seeds, std::span<const std::uint32_t> order);

}  // namespace sterna::tets
