// Constraints of a wall whose open boundary lies on planes: the symmetry plane of a half model, the walls of a tunnel.
#pragma once

#include <span>

#include "geom/mesh/topology.h"
#include "volmesh/envelope/constraint.h"

namespace sterna::volmesh {

/// Tolerance for vertices of the wall's boundary to lie on a plane, as a share of the body length: files keep 6 to 7 digits.
inline constexpr double k_rim_tolerance = 1e-6;

/// Returns the constraints of the wall's boundary vertices to the given planes: in one plane, or on the intersection line of two. Normals are oriented to the
/// side of the wall.
/// \throws Error(open_surface) with coordinates if a boundary vertex lies on none of the planes or on more than two, or if the wall lies on both sides of a
/// plane on which it ends.
Constraints constraints_of_planes(const TriMesh& wall, const Topology& topology, std::span<const ConstraintPlane> planes);

/// Returns the constraints with the planes detected: x, y or z = constant, where boundary edges lie in the plane and their triangles do not. Empty for a
/// closed wall.
/// \throws as above; the error states the number of open boundaries and the locations of edges that lie in no such plane.
Constraints constraints_of_rims(const TriMesh& wall, const Topology& topology);

}  // namespace sterna::volmesh
