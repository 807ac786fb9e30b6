// Order of insertion in which consecutive points are close together: rounds of doubling size (biased randomised: Amenta, Choi, Rote 2003), each along a Hilbert
// curve.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/math/predicates.h"

namespace sterna::delaunay {

/// Returns the indices 0 .. n - 1 in order of insertion; depends only on the points and their numbering. O(n log n).
/// \pre finite
std::vector<std::uint32_t> insertion_order(std::span<const Vec2> points);

/// Returns the indices of points along a Hilbert curve, without rounds: points close in this order are close in the plane.
std::vector<std::uint32_t> order_along_curve(std::span<const Vec2> points);

}  // namespace sterna::delaunay
