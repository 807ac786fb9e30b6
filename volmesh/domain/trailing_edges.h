// Sharp trailing edges of a triangulated wall.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// A chain of edges at which a wall ends downstream. The half-edges are consecutive. Their triangles belong to one side of the wing, those of their twins to
/// the other side.
struct TrailingEdge {
  std::vector<HalfedgeId> edges;
  bool is_loop = false;   ///< the last edge ends where the first starts
  bool is_blunt = false;  ///< the chain is the upper edge of a blunt base, so one of its sides is the base
};

/// Triangles that may belong to wings: those among the first `n_triangles` that belong to walls whose names match a pattern.
struct WingTriangles {
  std::string_view patches;
  std::size_t n_triangles;
};

/// Finds chains of edges between triangles of `wing`. At a sharp edge the wall turns by more than 120 degrees. In addition the angle between `stream` (unit)
/// and the outward direction of the edge, halfway between both sides, is below 70 degrees. At the edge of a blunt base the wall turns by 40 to 140 degrees. The
/// normal of the base is within 45 degrees of the stream, the normal of the side is more than 60 degrees from it, and the base is narrower than a tenth of the
/// chord. Of the two edges of a base, the one whose side faces up (z) is used, or the one whose side faces y > 0 if the side is upright. Chains end where edges
/// branch or bend by more than 60 degrees. Each chain has at least three edges. Chains are sorted by their lowest half-edge.
/// \pre `topology` is that of `wall`
std::vector<TrailingEdge> find_trailing_edges(const TriMesh& wall, const Topology& topology, const WingTriangles& wing, const Vec3& stream);

/// Returns the unit normal of a surface that continues the wing behind an edge of the chain. The normal points to the right of the chain. The surface runs
/// halfway between both sides of a sharp edge, and along the side of a blunt edge.
Vec3 normal_behind(const TriMesh& wall, const Topology& topology, HalfedgeId edge, bool is_blunt, const Vec3& stream);

/// Returns the local chord in metres at each vertex of a chain: the upstream extent of the wing's section through the vertex. A section is the connected set of
/// triangles of `wing` that are cut by the plane of the stream and the wing's normal at the edge. The ends of a chain that is no loop get the chord of their
/// neighbours. Then each value is replaced by the median of the values within half a chord.
/// \post there are as many values as vertices (edges + 1, or the number of edges of a loop)
std::vector<double> local_chords(const TriMesh& wall, const Topology& topology, const WingTriangles& wing, const Vec3& stream, const TrailingEdge& chain);

}  // namespace sterna::volmesh
