// One part of an end surface that is meshed in one plane: its loops, from edges to triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/mesh/size_sites.h"
#include "volmesh/rims/end_chart.h"
#include "volmesh/rims/end_surface.h"

namespace sterna::volmesh {

using EndEdge = std::array<std::uint32_t, 2>;

/// Edges index EndRegion::points, then EndTriangles::new_points.
struct EndPart {
  std::vector<EndEdge> edges;
  EndFrame frame;
  std::vector<TriangleId> triangles;      ///< of the original, that cover it; empty: a plane
  std::vector<SizeSite> curvature_sizes;  ///< what the surface's curvature allows
};

/// A point of the region, or of those that came later.
const Point& point_of(const EndRegion& region, const EndTriangles& result, std::uint32_t i);

/// \throws `info` with the places where as many edges do not end as begin
void check_closed(const EndRegion& region, const EndTriangles& result, std::span<const EndEdge> edges, ErrorInfo info);

/// Edges in closed loops of points; at points where several loops touch any way on is as good.
/// \pre check_closed
std::vector<std::vector<std::uint32_t>> closed_loops(std::span<const EndEdge> edges);

/// Meshes the part and proves it (end_surface.h); adds new points and triangles to the result.
void mesh_part(const EndRegion& region, const EndPart& part, const EndOptions& options, EndTriangles& result, const RunContext& context);

}  // namespace sterna::volmesh
