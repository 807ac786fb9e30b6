// Generated outer shapes around a wall: sphere, box, cylinder. They are closed and their normals point INTO the fluid. They are cut at the planes in which
// bodies end.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/farfield_options.h"

namespace sterna::volmesh {

/// A plane x, y or z = constant in which bodies end.
struct EndPlane {
  std::size_t axis = 1;
  double at = 0.0;      ///< m
  double inward = 1.0;  ///< +1: the fluid is where the coordinate is larger
};

/// Creates an icosahedral sphere around the centre of the wall's box, with one patch "farfield". It has 20 * f^2 triangles; f follows from the edge length. The
/// default is 500 triangles at 50 body lengths. Tetrahedra grow geometrically towards them, so the farfield needs only a few thousand cells.
/// \param ends planes in which bodies end. Unless the centre is given, it lies in such a plane, or midway between two parallel planes
/// \throws Error(bad_argument) if the sphere does not enclose the wall with a margin of a quarter of the body length, or would have more than 20 million
/// triangles; Error(empty_surface) for a wall without triangles
TriMesh farfield_sphere(const TriMesh& wall, const FarfieldOptions& options, const RunContext& context, std::span<const EndPlane> ends = {});

/// Creates an axis-parallel box from farfield_from to farfield_to, with the patches x_min, x_max, y_min etc. of kind farfield. Each side has its own edge
/// length. Edges between two sides have the edge length of the finer side, and triangles grow with the distance from them.
/// \throws Error(bad_argument) if the box does not enclose the wall with a margin of 0.02 body lengths (except sides beyond `ends`), or would have more than 20
/// million triangles
TriMesh farfield_box(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends, const RunContext& context);

/// Names of the sides of a box; the index is 2 * axis + (upper ? 1 : 0).
inline constexpr std::array k_box_sides = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

/// Creates one side of the box as an open mesh with one patch of kind farfield and normals into the box. \p edges edge lengths of the six sides of the box, m
/// \throws Error(bad_argument) if the box would have more than 20 million triangles
TriMesh box_side(const Box& box, const std::array<double, 6>& edges, std::size_t side, const RunContext& context);

/// Creates a circular cylinder from farfield_from to farfield_to, by default along x through the centre of the wall's box. It has the patches start, end and
/// side of kind farfield. Limits and errors are those of farfield_box.
TriMesh farfield_cylinder(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends, const RunContext& context);

}  // namespace sterna::volmesh
