// An order of insertion in which each point is near the one before: rounds of doubling size (biased randomised: Amenta, Choi, Rote 2003), each along Hilbert's
// curve.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/math/predicates.h"

namespace sterna::delaunay {

/// The indices 0 .. n - 1 in order of insertion; depends on the points and their numbering alone. O(n log n).
/// \pre finite
std::vector<std::uint32_t> insertion_order(std::span<const Vec2> points);

/// Indices of points along Hilbert's curve, without rounds: what is near in the plane is near in this order.
std::vector<std::uint32_t> order_along_curve(std::span<const Vec2> points);

}  // namespace sterna::delaunay
