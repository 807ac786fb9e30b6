// Sharp trailing edges of a triangulated wall.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// A chain of edges at which a wall ends downstream. Half-edges are consecutive; their triangles are one side of the wing, those of their twins the other.
struct TrailingEdge {
  std::vector<HalfedgeId> edges;
  bool is_loop = false;   ///< the last edge ends where the first starts
  bool is_blunt = false;  ///< upper edge of a blunt base: one side is the base
};

/// Candidate triangles for wings: among the first `n_triangles`, those of walls whose names match a pattern.
struct WingTriangles {
  std::string_view patches;
  std::size_t n_triangles;
};

/// Finds chains of edges between triangles of `wing`. Sharp edges: the wall turns by more than 120 degrees, and the angle between `stream` (unit) and the
/// direction halfway between both sides, across the edge, is below 70 degrees. Upper edges of blunt bases: the wall turns by 40 to 140 degrees between a base
/// whose normal is within 45 degrees of the stream and a side whose normal is not within 60; the base is narrower than a tenth of the chord. Of its two edges,
/// the one whose side faces up (z) is taken, or y > 0 if it is upright. Chains end where edges branch or bend by more than 60 degrees. Each has at least three
/// edges; sorted by their lowest half-edge.
/// \pre `topology` is that of `wall`
std::vector<TrailingEdge> find_trailing_edges(const TriMesh& wall, const Topology& topology, const WingTriangles& wing, const Vec3& stream);

/// Returns the unit normal, to the right of the chain, of a surface that continues behind an edge of the chain: halfway between both sides of a sharp edge,
/// along the side of a blunt edge.
Vec3 normal_behind(const TriMesh& wall, const Topology& topology, HalfedgeId edge, bool is_blunt, const Vec3& stream);

/// Returns the local chord at each vertex of a chain, m: the upstream extent of the wing's section through the vertex. A section is the connected set of
/// triangles of `wing` that are cut by the plane of stream and the wing's normal at the edge. Ends of a chain that is no loop have the chord of their
/// neighbours; then each value is replaced by the median of the values within half a chord.
/// \post as many as vertices (edges + 1, or edges of a loop)
std::vector<double> local_chords(const TriMesh& wall, const Topology& topology, const WingTriangles& wing, const Vec3& stream, const TrailingEdge& chain);

}  // namespace sterna::volmesh
