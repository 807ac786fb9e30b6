// One adjacent patch: a patch of the outer boundary on which prismatic layers end (symmetry plane, slip tunnel wall, fan face, ...), re-meshed around their
// footprint.
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

/// Region to be triangulated. The region is to the left of its edges, seen against the surface's normal (which points into the domain): its triangles have
/// exactly these half-edges as their border. Several outer borders, holes, islands in holes are allowed; loops may touch in points that they share by index.
struct EndRegion {
  const ConstraintSurface* surface = nullptr;       ///< \pre not null
  std::vector<Point> points;                        ///< points of the loops, on the surface; points that no edge uses do not count
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< edges of closed loops, in any order; never changed or split
  /// The patch as given (all triangles of the mesh), normals into the domain; null for a ConstraintPlane only. Its border is among the edges where no layer
  /// ends on it.
  const TriMesh* original = nullptr;
  /// Longest target edge at a location, metres; empty: as long as the growth from the loops allows.
  std::function<double(const Point&)> size;
  std::string name;  ///< name of the patch, for messages
};

struct EndTriangles {
  std::vector<Point> new_points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices: EndRegion::points, then new_points; normals into the domain
  std::int64_t n_kept = 0;                              ///< triangles of `original` that are unchanged; they come first
  double min_angle = 0.0;                               ///< rad, smallest angle of the other triangles, loops' corners included
  Point worst_place{};                                  ///< location of the smallest angle
};

/// Triangulates the region. Edge lengths: h(x) = min over the loops' points of (mean length of their edges + (size_growth - 1) distance), no longer than
/// `size`. Planes are meshed as a whole; new points have the coordinate of the loops' points (the median) to the bit if the normal is along a coordinate
/// axis, and lie in the plane to rounding otherwise. Other surfaces: smooth pieces of the original without a footprint stay unchanged. A piece whose normals
/// are within 70 degrees of their mean is meshed in that projection; new points are placed on the surface, angles are measured in space, and edges are short
/// enough for the surface's curvature. Of any other piece (a whole cylinder, a sphere) only the neighbourhood of the footprint is meshed. Edges of the
/// original that turn by more than 40 degrees stay; footprints may touch but not cross them. The result is proved before it is returned: every edge exactly
/// once a border edge in its sense, no other border, all triangles positive in their plane, Euler number. One thread; depends on the input alone; 200 to 300
/// k triangles/s on planes.
/// \throws Error(bad_argument) for loops that are not closed or have the wrong sense, points off the surface, a curved surface without original;
/// Error(self_intersection) with location and patch if loops cross or touch along an edge, or lie on the wrong side of each other (footprints that overlap or
/// leave the patch); Error(geometry_failed) if even the neighbourhood of a footprint has no projection; Error(overflow) for more than max_triangles
EndTriangles triangulate_end(const EndRegion& region, const EndOptions& options, const RunContext& context);

/// Returns the longest edge at a location of the region: the minimum of `size`, which may be empty, and of `edge` (m; automatic: no limit). Beside loops with
/// edges longer than `edge`, which stay, the limit is longer: sizes fall from there by size_growth - 1 per distance. Empty if neither limits.
std::function<double(const Point&)> limited_size(const EndRegion& region, double edge, double size_growth, std::function<double(const Point&)> size);

}  // namespace sterna::volmesh
