// Constraints of a wall whose open boundary lies on planes, such as the symmetry plane of a half model or the walls of a tunnel.
#pragma once

#include <span>

#include "geom/mesh/topology.h"
#include "volmesh/envelope/constraint.h"

namespace sterna::volmesh {

/// Tolerance for vertices of the wall's boundary to lie on a plane, as a fraction of the body length. Files keep 6 to 7 digits.
inline constexpr double k_border_tolerance = 1e-6;

/// Returns the constraints of the wall's boundary vertices to the given planes. A vertex is constrained to one plane, or to the intersection line of two
/// planes. Normals are oriented to the side of the wall.
/// \throws Error(open_surface) with coordinates if a boundary vertex lies on none of the planes or on more than two, or if the wall lies on both sides of a
/// plane in which it ends
Constraints constraints_of_planes(const TriMesh& wall, const Topology& topology, std::span<const ConstraintPlane> planes);

/// Detects the planes x, y or z = constant in which the wall ends, and returns the constraints to them. Such a plane contains boundary edges, but not their
/// triangles. Empty for a closed wall.
/// \throws the same errors; the message states the number of open boundaries and the locations of edges that lie in no such plane
Constraints constraints_of_borders(const TriMesh& wall, const Topology& topology);

}  // namespace sterna::volmesh
