// Decimates a large surface for a page: the vertices in each cube of a grid are merged into one of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::scripting {

struct ThinSurface {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of the given points
  std::vector<std::uint32_t> source;                    ///< index of the original triangle
};

/// Returns at most `most` triangles, or all if there are not more. Uses the finest grid that satisfies the limit. In each cube, the vertex next to the mean of
/// the cube's vertices replaces all of them. Triangles with two merged corners are removed; if several triangles have the same corners, the first is kept.
/// Deterministic.
/// \pre most >= 1
ThinSurface thin_surface(std::span<const Point> points, std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t most);

}  // namespace sterna::scripting
