// Splits of boundary triangles by an engine that has permission to split them: new points on the boundary, each with its location in an input triangle.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

struct TetraBoundary;

/// A subdivision of a boundary's triangles. A point on an edge is a single point, which both triangles at the edge share.
struct BoundarySplits {
  /// Location of a point: barycentric coordinates with the sum 1. The coordinate of the corner opposite to the split edge is exactly zero.
  struct Origin {
    std::uint32_t triangle = 0;
    std::array<double, 3> weights{};
  };
  std::vector<Vec3> points;                             ///< m; the node number of a point is the number of boundary points + its index
  std::vector<Origin> origins;                          ///< location of each point
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< all triangles of the new boundary, oriented like their parents and in the order of their parents
  std::vector<std::uint32_t> parents;                   ///< parent of each triangle: the input triangle of which it is a part
  bool empty() const { return points.empty(); }
};

/// Finds origins and orientations. Verifies that the triangles of each parent tile it: their corners are in the parent, and their areas in its barycentric
/// coordinates are positive and have the sum 1. \p points all nodes that `triangles` use: boundary points first, then only points that some triangle uses. \p
/// parents parent of each triangle, in any order
/// \throws Error(tetra_result_invalid) with the first location if the triangles are no such subdivision
BoundarySplits find_splits(const TetraBoundary& boundary, std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                           std::span<const std::uint32_t> parents);

}  // namespace sterna::volmesh
