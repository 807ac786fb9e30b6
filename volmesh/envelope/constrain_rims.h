// Constraints of a wall that ends on planes: the symmetry plane of a half model, the walls of a tunnel.
#pragma once

#include <span>

#include "geom/mesh/topology.h"
#include "volmesh/envelope/constraint.h"

namespace sterna::volmesh {

/// Vertices of the wall's boundary within this of a plane are on it, share of the body length: files keep 6 to 7 digits.
inline constexpr double k_rim_tolerance = 1e-6;

/// Constraints of the wall's boundary vertices to the given planes: in a plane, or on the line of two. Normals are turned to the side where the wall is.
/// \throws Error(open_surface) with coordinates when a boundary vertex is on none of the planes or on more than two, or when the wall lies on both sides
/// of a plane that it ends on.
Constraints constraints_of_planes(const TriMesh& wall, const Topology& topology, std::span<const ConstraintPlane> planes);

/// The same with the planes found: x, y or z = constant, where boundary edges lie in it, and their triangles do not. Empty for a closed wall.
/// \throws as above; the error names how many rims there are, and where the edges are that lie in no such plane.
Constraints constraints_of_rims(const TriMesh& wall, const Topology& topology);

}  // namespace sterna::volmesh
