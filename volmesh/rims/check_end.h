// Proof that triangles fill a region: triangulate_end returns no result that has not passed it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/math/predicates.h"
#include "volmesh/rims/end_part.h"

namespace sterna::volmesh {

struct EndCheck {
  std::vector<EndEdge> missing;   ///< edges of the region that are not the border half-edge of exactly one triangle
  std::vector<EndEdge> reversed;  ///< edges of `missing` whose reverse is such a half-edge
  std::vector<EndEdge> open;      ///< half-edges of the triangles without a twin that are no edges of the region
  std::vector<EndEdge> repeated;  ///< half-edges of more than one triangle
  std::int64_t n_components = 0;  ///< sets of triangles joined by edges
  std::int64_t n_loops = 0;       ///< closed walks along border half-edges, within fans of triangles
  std::int64_t euler_number = 0;  ///< Euler number of the surface in which each fan of triangles at a vertex has its own vertex
  /// Returns true if the triangles are pieces of the plane: each a disc with holes.
  bool is_planar() const { return euler_number == 2 * n_components - n_loops; }
  /// Returns true if the border is correct, no half-edge occurs twice, and the triangles are planar. The final check.
  bool is_valid() const { return missing.empty() && open.empty() && repeated.empty() && is_planar(); }
};

/// Checks triangles against the edges of a region. O(n log n). Planarity is tested only if all other checks pass.
EndCheck check_end(std::span<const EndEdge> edges, std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace sterna::volmesh
