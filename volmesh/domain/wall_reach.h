// Distance along a wall that a layer can reach from marked vertices.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Number of surfaces that have bits in the mask Constraints::near; the collider still handles the others.
inline constexpr std::int32_t k_max_masked = 64;

/// Graph of a wall's edges, for distances along the wall. A layer is at most a few mean edges thick, and reaches no farther along the wall.
class WallReach {
 public:
  /// `wall` may change afterwards: the stored lengths stay.
  explicit WallReach(const TriMesh& wall);

  /// Sets the bit of the surface (none from k_max_masked on) in `near` at vertices whose path along edges from the nearest of `from` is at most 8 mean edges
  /// long. All vertices on the path must also fulfil this condition and may_pass() (all, if it is empty; `from` need not). Paths end at vertices that already
  /// have the bit.
  void mark(std::span<const VertexId> from, std::int32_t surface, const std::function<bool(VertexId)>& may_pass, Column<VertexId, std::uint64_t>& near) const;

 private:
  Column<VertexId, std::vector<std::pair<VertexId, double>>> neighbours_;  ///< neighbours with the edge's length, m; inner edges twice
  Column<VertexId, double> mean_edge_;                                     ///< m
};

}  // namespace sterna::volmesh
