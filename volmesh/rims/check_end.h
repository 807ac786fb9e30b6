// Proof that triangles are those of a region: nothing that triangulate_end returns has not passed it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/math/predicates.h"
#include "volmesh/rims/end_part.h"

namespace sterna::volmesh {

struct EndCheck {
  std::vector<EndEdge> missing;   ///< edges of the region that are not the border half-edge of one triangle
  std::vector<EndEdge> reversed;  ///< of these, those whose reverse is one
  std::vector<EndEdge> open;      ///< half-edges of the triangles without a twin that are no edges of the region
  std::vector<EndEdge> repeated;  ///< half-edges of more than one triangle
  std::int64_t n_components = 0;  ///< of triangles joined by edges
  std::int64_t n_loops = 0;       ///< closed walks along border half-edges, within fans of triangles
  std::int64_t euler_number = 0;  ///< of the surface with each fan at a vertex a vertex of its own
  /// Pieces of the plane: a disc with holes each.
  bool is_planar() const { return euler_number == 2 * n_components - n_loops; }
  /// The last line of defence: border right, no half-edge twice, planar.
  bool is_valid() const { return missing.empty() && open.empty() && repeated.empty() && is_planar(); }
};

/// O(n log n). Planarity is looked at when all else is right.
EndCheck check_end(std::span<const EndEdge> edges, std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace sterna::volmesh
