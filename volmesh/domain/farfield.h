// The outer shapes that are made here, each about a wall: sphere, box, cylinder. Closed, normals INTO the fluid; to be cut where bodies end in planes.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/farfield_options.h"

namespace sterna::volmesh {

/// A plane x, y or z = constant that bodies end on.
struct EndPlane {
  std::size_t axis = 1;
  double at = 0.0;      ///< m
  double inward = 1.0;  ///< +1: the fluid is where the coordinate is larger
};

/// Icosahedral sphere (20 * f^2 triangles, f chosen from the edge length) about the centre of the wall's box; one patch "farfield".
/// Default: 500 triangles at 50 body lengths; the tetrahedra grow towards them geometrically, so that the farfield costs a few thousand.
/// \param ends the centre is in such a plane, or amid two that are parallel, unless it is given
/// \throws Error(bad_argument) when the sphere does not enclose the wall with a margin of a quarter of the body length, or would have more than
/// 20 million triangles; Error(empty_surface) for a wall without triangles.
TriMesh farfield_sphere(const TriMesh& wall, const FarfieldOptions& options, const RunContext& context, std::span<const EndPlane> ends = {});

/// Axis-parallel box from farfield_from to farfield_to; patches x_min, x_max, y_min ... of kind farfield. Sides have their own edge lengths, the edges between
/// them that of the finer; triangles grow away from finer edges.
/// \throws Error(bad_argument) when it does not enclose the wall with a margin of 0.02 body lengths (but for sides beyond `ends`), or would have more than 20
/// million triangles
TriMesh farfield_box(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends, const RunContext& context);

/// Names of a box's sides: 2 * axis + (upper ? 1 : 0).
inline constexpr std::array k_box_sides = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

/// One side of the box with these edge lengths (m, of its six sides): open, one patch of kind farfield, normals into the box.
/// \throws Error(bad_argument) when the box would have more than 20 million triangles
TriMesh box_side(const Box& box, const std::array<double, 6>& edges, std::size_t side, const RunContext& context);

/// Circular cylinder from farfield_from to farfield_to, along x through the centre of the wall's box by default; patches start, end, side of kind farfield. As
/// farfield_box.
TriMesh farfield_cylinder(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends, const RunContext& context);

}  // namespace sterna::volmesh
