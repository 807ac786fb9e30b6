// Triangulates the inside of a convex plane polygon with given sizes. The border of the polygon stays unchanged. Used for the flat sides of outer boundaries.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/math/predicates.h"

namespace sterna::volmesh {

struct LocalSize {
  double edge = 0.0;         ///< target edge length
  double from_border = 0.0;  ///< distance from the polygon; no points are made nearer than about half an edge
};

struct PolygonFill {
  std::vector<Vec2> points;                             ///< the points of the polygon come first
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise
};

/// Triangulates the polygon by Delaunay refinement.
/// \pre the polygon is counter-clockwise
/// \throws Error(self_intersection) when the polygon crosses itself
PolygonFill fill_polygon(std::span<const Vec2> polygon, const std::function<LocalSize(const Vec2&)>& size, const RunContext& context);

/// Triangulates the area inside an odd number of the loops that the segments form. Triangles are counter-clockwise, and there are no new points.
/// \throws Error(self_intersection) with the location (z = 0) where segments cross
std::vector<std::array<std::uint32_t, 3>> triangulate_borders(std::span<const Vec2> points, std::span<const std::array<std::uint32_t, 2>> segments,
                                                              const RunContext& context);

}  // namespace sterna::volmesh
