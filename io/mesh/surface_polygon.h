// Splits one polygon of a surface file into triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::io {

/// Most corners that a polygon may have: ear clipping takes time in proportion to the square of it (at worst the cube).
inline constexpr std::size_t k_max_polygon_corners = 4096;

/// Appends n - 2 triangles (indices into `corners`, same sense as the polygon) to `triangles`.
/// Triangles stay. Quads take the diagonal that lies inside; of two such, the shorter one; if equal, the one from corner 0. Larger polygons
/// become a fan about corner 0 when that is convex there, else ears are clipped in the plane of the mean normal. What remains of a
/// polygon without an ear (degenerate or crossing itself) becomes a fan: the surface's own checks judge it.
/// \pre 3 <= corners.size() <= k_max_polygon_corners; coordinates are finite
void split_polygon(std::span<const Vec3> corners, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace sterna::io
