// How far along a wall a layer can reach from marked vertices.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Surfaces that a mask of Constraints::near has bits for; the collider sees the others still.
inline constexpr std::int32_t k_max_masked = 64;

/// Edges of a wall as ways. A layer is not thicker than some mean edges by much, nor does it reach farther along the wall.
class WallReach {
 public:
  /// `wall` may change afterwards: the lengths stay what they are.
  explicit WallReach(const TriMesh& wall);

  /// Sets the bit of the surface (none from k_max_masked on) in `near` at vertices whose way along edges from the nearest of `from` is no longer than 8 mean
  /// edges there, by vertices that are so, too, and may_pass() (all, where it is empty; `from` need not). Vertices that have the bit end ways.
  void mark(std::span<const VertexId> from, std::int32_t surface, const std::function<bool(VertexId)>& may_pass, Column<VertexId, std::uint64_t>& near) const;

 private:
  Column<VertexId, std::vector<std::pair<VertexId, double>>> neighbours_;  ///< with the edge's length, m; on inner edges twice
  Column<VertexId, double> mean_edge_;                                     ///< m
};

}  // namespace sterna::volmesh
