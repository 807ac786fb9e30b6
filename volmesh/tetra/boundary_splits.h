// Boundary splits made by an engine that was allowed to split triangles: new points on the boundary, each with its location in an input triangle.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

struct TetraBoundary;

/// A subdivision of a boundary's triangles. A point on an edge is a single point, shared by both triangles there.
struct BoundarySplits {
  /// Location of a point: barycentric coordinates, summing to 1; exactly zero for the corner opposite to the edge that it splits.
  struct Origin {
    std::uint32_t triangle = 0;
    std::array<double, 3> weights{};
  };
  std::vector<Vec3> points;                             ///< m; node number = n boundary points + index
  std::vector<Origin> origins;                          ///< for each point
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< all triangles of the new boundary, with the orientation and in the order of their parents
  std::vector<std::uint32_t> parents;                   ///< for each triangle: the input triangle that it is a part of
  bool empty() const { return points.empty(); }
};

/// Finds origins and orientations, and verifies that the triangles of each parent tile it: corners in it, positive areas in its barycentric coordinates, which
/// sum to 1. \p points: all nodes that `triangles` use, boundary points first, then only points that some triangle uses; \p parents: for each triangle, in any
/// order.
/// \throws Error(tetra_result_invalid) with the first location if it is no such subdivision.
BoundarySplits find_splits(const TetraBoundary& boundary, std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                           std::span<const std::uint32_t> parents);

}  // namespace sterna::volmesh
