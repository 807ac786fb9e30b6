// One part of an adjacent patch that is meshed in one plane, from its edges through loops to triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/mesh/size_points.h"
#include "volmesh/adjacent/adjacent_chart.h"
#include "volmesh/adjacent/adjacent_surface.h"

namespace sterna::volmesh {

using AdjacentEdge = std::array<std::uint32_t, 2>;

/// Part of a region. Its edges refer to AdjacentRegion::points, followed by AdjacentTriangles::new_points.
struct AdjacentPart {
  std::vector<AdjacentEdge> edges;
  AdjacentFrame frame;
  std::vector<TriangleId> triangles;       ///< triangles of the original that cover the part; empty: the part is plane
  std::vector<SizePoint> curvature_sizes;  ///< sizes limited by the surface's curvature
};

/// Returns point i: a point of the region, or a new point of the result.
const Point& point_of(const AdjacentRegion& region, const AdjacentTriangles& result, std::uint32_t i);

/// \throws `info` with the locations at which the numbers of ending and beginning edges differ
void check_closed(const AdjacentRegion& region, const AdjacentTriangles& result, std::span<const AdjacentEdge> edges, ErrorInfo info);

/// Joins edges to closed loops of points. At points that several loops share, any continuation is valid.
/// \pre check_closed has passed
std::vector<std::vector<std::uint32_t>> closed_loops(std::span<const AdjacentEdge> edges);

/// Meshes the part and checks the result (adjacent_surface.h). Adds new points and triangles to the result.
void mesh_part(const AdjacentRegion& region, const AdjacentPart& part, const EndOptions& options, AdjacentTriangles& result, const RunContext& context);

}  // namespace sterna::volmesh
