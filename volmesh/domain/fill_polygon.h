// Triangles of given sizes inside a convex polygon of the plane whose border stays as it is: the flat sides of outer boundaries.
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
  double edge = 0.0;         ///< wanted edge length
  double from_border = 0.0;  ///< distance from the polygon: points nearer than about half an edge are not made
};

struct PolygonFill {
  std::vector<Vec2> points;                             ///< those of the polygon first
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise
};

/// Delaunay refinement of the polygon.
/// \pre counter-clockwise
/// \throws Error(self_intersection) when the polygon crosses itself
PolygonFill fill_polygon(std::span<const Vec2> polygon, const std::function<LocalSize(const Vec2&)>& size, const RunContext& context);

/// Triangles, counter-clockwise, of what is inside an odd number of the rims that the segments make; no new points.
/// \throws Error(self_intersection) with the place (z = 0) where segments cross
std::vector<std::array<std::uint32_t, 3>> triangulate_rims(std::span<const Vec2> points, std::span<const std::array<std::uint32_t, 2>> segments,
                                                           const RunContext& context);

}  // namespace sterna::volmesh
