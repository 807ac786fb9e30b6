// Fewer triangles of a large surface for a page: vertices of one cube of a grid become one of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::scripting {

struct ThinSurface {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of points' numbers as given
  std::vector<std::uint32_t> source;                    ///< the triangle that each was
};

/// At most `most` triangles: of each cube of the smallest grid that does it, the vertex next to the mean of its vertices stands for all; triangles of which two
/// corners fell together go, and of those with the same corners the first stays. All of them where there are not more. Deterministic.
/// \pre most >= 1
ThinSurface thin_surface(std::span<const Point> points, std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t most);

}  // namespace sterna::scripting
