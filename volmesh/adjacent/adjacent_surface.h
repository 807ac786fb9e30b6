// An adjacent patch is a patch of the outer boundary on which prismatic layers end (symmetry plane, slip wall of a tunnel, fan face etc.). It is re-meshed
// around their footprint.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/end_options.h"
#include "volmesh/envelope/constraint.h"

namespace sterna::volmesh {

/// Region to be triangulated. The region is to the left of its edges, as seen against the surface's normal (which points into the domain), so the border of its
/// triangles consists of exactly these half-edges. Several outer borders, holes, and islands in holes are allowed. Loops may touch in points that they share by
/// index.
struct AdjacentRegion {
  const ConstraintSurface* surface = nullptr;       ///< \pre not null
  std::vector<Point> points;                        ///< points of the loops, on the surface; points without edges are ignored
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< edges of closed loops, in any order; never changed or split
  /// The given patch (all triangles of the mesh), with normals into the domain. It may be null only for a ConstraintPlane. Where no layer ends on the patch,
  /// its border is part of `edges`.
  const TriMesh* original = nullptr;
  /// Longest target edge at a location in metres. Empty: edges are as long as the growth from the loops allows.
  std::function<double(const Point&)> size;
  std::string name;  ///< name of the patch, for messages
};

struct AdjacentTriangles {
  std::vector<Point> new_points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices refer to AdjacentRegion::points, followed by new_points; normals point into the domain
  std::int64_t n_kept = 0;                              ///< number of unchanged triangles of `original`, which come first
  double min_angle = 0.0;                               ///< rad, smallest angle of the other triangles, including the corners of loops
  Point worst_location{};                               ///< location of the smallest angle
};

/// Triangulates the region. Edge lengths: h(x) = min over the loops' points of (mean length of their edges + (size_growth - 1) distance), no longer than
/// `size`. Planes are meshed as a whole. If the normal is along a coordinate axis, new points have bit-exactly the (median) coordinate of the loops' points;
/// otherwise they lie in the plane except for rounding. On other surfaces, smooth pieces of the original without a footprint stay unchanged. A piece whose
/// normals are within 70 degrees of their mean is meshed in that projection. New points are placed on the surface, angles are measured in space, and edges are
/// short enough for the surface's curvature. Of other pieces (a whole cylinder, a sphere) only the neighbourhood of the footprint is meshed. Edges of the
/// original that turn by more than 40 degrees stay; footprints may touch them but not cross them. The result is checked before it is returned: every edge is
/// exactly once a border edge in its direction, there is no other border, all triangles are positive in their plane, and the Euler number is correct. The
/// function uses one thread, and the result depends on the input alone. It makes 200 000 to 300 000 triangles per second on planes.
/// \throws Error(bad_argument) for loops that are not closed or have the wrong direction, points that are not on the surface, or a curved surface without
/// original; Error(self_intersection) with location and patch if loops cross, touch along an edge, or lie on the wrong side of each other (footprints that
/// overlap or leave the patch); Error(geometry_failed) if even the neighbourhood of a footprint has no projection; Error(overflow) for more than max_triangles
AdjacentTriangles triangulate_adjacent(const AdjacentRegion& region, const EndOptions& options, const RunContext& context);

/// Returns the longest edge at a location of the region: the minimum of `size` (may be empty) and `edge` (m; automatic: no limit). Loop edges longer than
/// `edge` stay. Beside them the limit is longer, and sizes decrease from there by size_growth - 1 per distance. Returns an empty function if there is no limit.
std::function<double(const Point&)> limited_size(const AdjacentRegion& region, double edge, double size_growth, std::function<double(const Point&)> size);

}  // namespace sterna::volmesh
