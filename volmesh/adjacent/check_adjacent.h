// Checks that triangles fill a region. triangulate_adjacent returns only results that pass this check.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/math/predicates.h"
#include "volmesh/adjacent/adjacent_part.h"

namespace sterna::volmesh {

struct AdjacentCheck {
  std::vector<AdjacentEdge> missing;   ///< edges of the region that are not a border half-edge of exactly one triangle
  std::vector<AdjacentEdge> reversed;  ///< edges of `missing` whose reverse is a border half-edge of exactly one triangle
  std::vector<AdjacentEdge> open;      ///< half-edges of triangles that have no twin and are no edges of the region
  std::vector<AdjacentEdge> repeated;  ///< half-edges that more than one triangle contains
  std::int64_t n_components = 0;       ///< number of sets of triangles that are joined by edges
  std::int64_t n_loops = 0;            ///< number of closed walks along border half-edges, within fans of triangles
  std::int64_t euler_number = 0;       ///< Euler number of the surface in which each fan of triangles at a vertex has a separate vertex
  /// Returns true if the triangles form pieces of the plane, each of which is a disc with holes.
  bool is_planar() const { return euler_number == 2 * n_components - n_loops; }
  /// Returns true if the border is correct, no half-edge occurs twice, and the triangles are planar. This is the final check.
  bool is_valid() const { return missing.empty() && open.empty() && repeated.empty() && is_planar(); }
};

/// Checks triangles against the edges of a region. O(n log n). Planarity is tested only if all other checks pass.
AdjacentCheck check_adjacent(std::span<const AdjacentEdge> edges, std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace sterna::volmesh
