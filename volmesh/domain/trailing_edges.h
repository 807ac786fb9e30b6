// Sharp trailing edges of a triangulated wall.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// A chain of edges at which a wall ends downstream. Half-edges follow each other; their triangles are one side of the wing, those of their twins the other.
struct TrailingEdge {
  std::vector<HalfedgeId> edges;
  bool is_loop = false;   ///< the last one ends where the first one starts
  bool is_blunt = false;  ///< upper edge of a blunt base: one side is the base
};

/// Triangles that may be parts of a wing: of the first `n_triangles` those of walls whose names match a pattern.
struct WingTriangles {
  std::string_view patches;
  std::size_t n_triangles;
};

/// Chains of edges between triangles of `wing`. Sharp ones: the wall turns by more than 120 degrees, and the angle between `stream` (unit) and the direction
/// halfway between both sides, across the edge, is below 70 degrees. Upper edges of blunt bases: the wall turns by 40 to 140 degrees between a base that looks
/// downstream within 45 degrees and a side that does not within 60; the base is narrower than a tenth of the chord; of its two edges the one whose side looks
/// up (z), or to y > 0 where it stands upright. Chains end where edges branch or bend by more than 60 degrees. At least three edges each; sorted by their
/// lowest half-edge.
/// \pre `topology` is that of `wall`
std::vector<TrailingEdge> find_trailing_edges(const TriMesh& wall, const Topology& topology, const WingTriangles& wing, const Vec3& stream);

/// Unit: normal of a surface that goes on behind an edge of a chain, towards the right of it: halfway between both sides of a sharp edge, along the side of a
/// blunt one.
Vec3 normal_behind(const TriMesh& wall, const Topology& topology, HalfedgeId edge, bool is_blunt, const Vec3& stream);

/// How far the section of the wing through each vertex of a chain reaches against the stream, m: its local chord. A section is what hangs together of the
/// triangles of `wing` that are cut by the plane of stream and the wing's normal at the edge. Ends of a chain that is no loop have that of their
/// neighbours, and all the median of those within half a chord.
/// \post as many as vertices (edges + 1, or edges of a loop)
std::vector<double> local_chords(const TriMesh& wall, const Topology& topology, const WingTriangles& wing, const Vec3& stream, const TrailingEdge& chain);

}  // namespace sterna::volmesh
