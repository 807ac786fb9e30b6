// Generated outer shapes around a wall: sphere, box, cylinder. Closed, normals INTO the fluid; they are cut where bodies end in planes.
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

/// Creates an icosahedral sphere (20 * f^2 triangles, f chosen from the edge length) about the centre of the wall's box; one patch "farfield". Default: 500
/// triangles at 50 body lengths; the tetrahedra grow towards them geometrically, so that the farfield costs a few thousand cells.
/// \param ends unless the centre is given, it lies in such a plane, or midway between two parallel planes
/// \throws Error(bad_argument) if the sphere does not enclose the wall with a margin of a quarter of the body length, or would have more than 20 million
/// triangles; Error(empty_surface) for a wall without triangles.
TriMesh farfield_sphere(const TriMesh& wall, const FarfieldOptions& options, const RunContext& context, std::span<const EndPlane> ends = {});

/// Creates an axis-parallel box from farfield_from to farfield_to; patches x_min, x_max, y_min ... of kind farfield. Each side has its own edge length; edges
/// between two sides have that of the finer side; triangles grow away from finer edges.
/// \throws Error(bad_argument) if the box does not enclose the wall with a margin of 0.02 body lengths (except sides beyond `ends`), or would have more than 20
/// million triangles
TriMesh farfield_box(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends, const RunContext& context);

/// Names of a box's sides: 2 * axis + (upper ? 1 : 0).
inline constexpr std::array k_box_sides = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

/// Creates one side of the box with these edge lengths (m, of its six sides): open, one patch of kind farfield, normals into the box.
/// \throws Error(bad_argument) if the box would have more than 20 million triangles
TriMesh box_side(const Box& box, const std::array<double, 6>& edges, std::size_t side, const RunContext& context);

/// Creates a circular cylinder from farfield_from to farfield_to, by default along x through the centre of the wall's box; patches start, end, side of kind
/// farfield. Limits and errors as for farfield_box.
TriMesh farfield_cylinder(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends, const RunContext& context);

}  // namespace sterna::volmesh
