// One end surface: a patch of the outer boundary on which prismatic layers end (symmetry plane, slip tunnel wall, fan face, ...), triangulated anew around
// their footprint.
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

/// What has to be triangulated. The region is to the left of its edges, seen against the surface's normal (which looks into the domain): its triangles have
/// exactly these half-edges as their border. Several outer borders, holes, islands in holes; loops may touch each other in points that they share by index.
struct EndRegion {
  const ConstraintSurface* surface = nullptr;       ///< \pre not null
  std::vector<Point> points;                        ///< of the loops, on the surface; points that no edge uses do not count
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< of closed loops, in any order; kept as they are, never split
  /// The patch as it was given (all of the mesh), normals into the domain; null for a ConstraintPlane only. Its border is among the edges where no layer ends
  /// on it.
  const TriMesh* original = nullptr;
  /// Longest edge wanted at a place, metres; empty: as long as the growth from the loops allows.
  std::function<double(const Point&)> size;
  std::string name;  ///< of the patch, for messages
};

struct EndTriangles {
  std::vector<Point> new_points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices: EndRegion::points, then new_points; normals into the domain
  std::int64_t n_kept = 0;                              ///< triangles of `original` that are as they were; they come first
  double min_angle = 0.0;                               ///< rad, smallest angle of the others, loops' corners included
  Point worst_place{};                                  ///< where it is
};

/// Triangulates the region. Edge lengths: h(x) = min over the loops' points of (mean length of their edges + (size_growth - 1) distance), no longer than
/// `size`. Planes: as a whole; new points have the coordinate of the loops' points (the median) to the bit when the normal is along a coordinate axis, and lie
/// in the plane to rounding otherwise. Other surfaces: smooth pieces of the original without a footprint stay as they are; a piece whose normals are within 70
/// degrees of their mean is meshed in that projection, new points put on the surface, angles judged in space, edges short enough for the surface's curvature;
/// of any other piece (a whole cylinder, a sphere) only the neighbourhood of the footprint is. Edges of the original that turn by more than 40 degrees stay;
/// footprints may touch but not cross them. The result is proved before it is returned: every edge exactly once a border edge in its sense, no other border,
/// all triangles positive in their plane, Euler number. One thread; depends on the input alone; 200 to 300 k triangles/s on planes.
/// \throws Error(bad_argument) for loops that are not closed or run the wrong way, points off the surface, a curved surface without original;
/// Error(self_intersection) where loops cross or touch along an edge, or lie on the wrong side of each other (footprints that overlap or leave the patch), with
/// place and patch; Error(geometry_failed) where even the neighbourhood of a footprint has no projection; Error(overflow) for more than max_triangles
EndTriangles triangulate_end(const EndRegion& region, const EndOptions& options, const RunContext& context);

/// Longest edge at a place of the region: `edge` (m; automatic: no limit), longer beside loops of longer edges, which stay and from where sizes fall by
/// size_growth - 1 per distance; and `size`, which may be empty. Empty where neither limits.
std::function<double(const Point&)> limited_size(const EndRegion& region, double edge, double size_growth, std::function<double(const Point&)> size);

}  // namespace sterna::volmesh
