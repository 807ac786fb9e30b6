// Constrained Delaunay triangulation of points and segments in the plane; every decision is exact.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/delaunay/cavity.h"
#include "geom/delaunay/triangulation.h"

namespace sterna::delaunay {

/// The empty circle in the plane, exact. Ghost triangles are in conflict with points beyond their edge of the hull, or on it.
struct PlanarCriterion {
  static constexpr bool k_needs_normals = false;
  bool conflicts(const Triangulation& mesh, TriangleId t, VertexId p) const;
};

/// Part of the boundary or a line inside; the ends are indices of points.
struct Segment {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  bool is_border = true;  ///< the domain boundary; `false`: an inner line that edges must follow
};

enum class Extent {
  hull,    ///< the whole convex hull
  inside,  ///< the region inside an odd number of borders (outer borders, holes, islands in holes)
};

struct PlanarTriangulation {
  Triangulation mesh;             ///< vertex i is point i; contains the ghost's triangles with Extent::hull, no outside triangles with Extent::inside
  std::vector<VertexId> same_as;  ///< for each point: itself, or the coincident point that represents it (its own vertex is unused)
};

/// Triangulates points and segments. Coincident points are merged into the one inserted first; a point on a segment splits it; overlapping segments become one
/// edge, a border where an odd number of borders overlap; segments of zero length are ignored. If all points are collinear, there are no triangles. About 0.6
/// us per point; depends on the input only.
/// \throws Error(self_intersection) with the location (z = 0) where two segments cross; Error(bad_argument) for a coordinate that is not finite or an index out
/// of range
PlanarTriangulation triangulate_plane(std::span<const Vec2> points, std::span<const Segment> segments, Extent extent, const RunContext& context);

/// Returns the existing real triangles in ascending order of their slots.
std::vector<TriangleVertices> extract_triangles(const Triangulation& mesh);

/// Makes the edge from a to b constrained, passing through vertices on the way; flips crossing edges and restores the empty circle beside it.
/// \pre both in the triangulation, which has its ghost
/// \throws Error(self_intersection) where a constrained edge is in the way
void insert_segment(Triangulation& mesh, VertexId a, VertexId b, bool is_border);

/// Removes all triangles that are not inside an odd number of borders, including the ghost's triangles; slots are renumbered in the same order.
/// \post edges of the domain's border have no twin
void carve(Triangulation& mesh);

}  // namespace sterna::delaunay
