// Constrained Delaunay triangulation of points and segments in the plane, exact in every decision.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/delaunay/cavity.h"
#include "geom/delaunay/triangulation.h"

namespace sterna::delaunay {

/// The empty circle in the plane, exact. Ghost triangles: conflict with what lies beyond their edge of the hull, or on it.
struct PlanarCriterion {
  static constexpr bool k_needs_normals = false;
  bool conflicts(const Triangulation& mesh, TriangleId t, VertexId p) const;
};

/// Part of the boundary or a line inside; ends are indices of points.
struct Segment {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  bool is_border = true;  ///< the domain changes sides here; `false`: edges must follow it, no more
};

enum class Extent {
  hull,    ///< all of the convex hull
  inside,  ///< what lies inside an odd number of borders (outer borders, holes, islands in holes)
};

struct PlanarTriangulation {
  Triangulation mesh;             ///< vertex i is point i; with Extent::hull the ghost's triangles are in it, with inside they and all outside are not
  std::vector<VertexId> same_as;  ///< of each point: itself, or the point at the same place that stands for it (its own vertex is unused)
};

/// Triangulates points and segments. Points at the same place become one (the one inserted first); a point on a segment splits it; overlapping segments become
/// one edge, a border where an odd number of borders overlap; segments without length are ignored. All points on one line: no triangles.
/// About 0.6 us a point; depends on the input alone.
/// \throws Error(self_intersection) with the place (z = 0) where two segments cross; Error(bad_argument) for a coordinate that is not finite or an index out of
/// range
PlanarTriangulation triangulate_plane(std::span<const Vec2> points, std::span<const Segment> segments, Extent extent, const RunContext& context);

/// The real, living triangles in ascending order of their slots.
std::vector<TriangleVertices> extract_triangles(const Triangulation& mesh);

/// Makes the edge from a to b a constrained one, passing through vertices on the way; flips what crosses and restores the empty circle beside it.
/// \pre both in the triangulation, which has its ghost
/// \throws Error(self_intersection) where a constrained edge is in the way
void insert_segment(Triangulation& mesh, VertexId a, VertexId b, bool is_border);

/// Takes away all that is not inside an odd number of borders, the ghost's triangles too; slots are renumbered, their order is kept.
/// \post edges of the domain's border have no twin
void carve(Triangulation& mesh);

}  // namespace sterna::delaunay
