// Splitting of a polygon of a surface file into triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::io {

/// Maximum number of corners of a polygon. The time of ear clipping grows with the square of this number, at worst with the cube.
inline constexpr std::size_t k_max_polygon_corners = 4096;

/// Appends n - 2 triangles (indices into `corners`, same orientation as the polygon) to `triangles`.
/// Triangles are unchanged. Quads are split by the diagonal that lies inside; if both do, by the shorter one; if both are equally long, by the one from corner
/// 0. Larger polygons become a triangle fan about corner 0 if every triangle of that fan is valid; otherwise ears are clipped in the plane of the mean normal.
/// The remainder of a polygon without an ear (degenerate or self-intersecting) becomes a triangle fan; the surface checks decide whether it is valid.
/// \pre 3 <= corners.size() <= k_max_polygon_corners; coordinates are finite
void split_polygon(std::span<const Vec3> corners, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace sterna::io
