// Finds the part of a wall that a layer can reach from marked vertices.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Number of surfaces that have bits in the mask Constraints::near. The collider alone handles surfaces with higher numbers.
inline constexpr std::int32_t k_max_masked = 64;

/// Graph of a wall's edges, used for distances along the wall. A layer is at most a few mean edges thick, so it reaches no farther along the wall.
class WallReach {
 public:
  /// `wall` may change afterwards, because the lengths are stored.
  explicit WallReach(const TriMesh& wall);

  /// Sets the bit of the surface in `near` (no bit if its number is k_max_masked or more). The bit is set at vertices whose path along edges from the nearest
  /// vertex of `from` is at most 8 mean edges long. All vertices on the path must also fulfil this condition and may_pass(). If may_pass is empty, all vertices
  /// pass; vertices of `from` need not pass. Paths end at vertices that already have the bit.
  void mark(std::span<const VertexId> from, std::int32_t surface, const std::function<bool(VertexId)>& may_pass, Column<VertexId, std::uint64_t>& near) const;

 private:
  /// Neighbours of each vertex with the length of the edge, m; inner edges are stored twice.
  Column<VertexId, std::vector<std::pair<VertexId, double>>> neighbours_;
  Column<VertexId, double> mean_edge_;  ///< m
};

}  // namespace sterna::volmesh
