// Rooms seen from inside: closed walls whose normals point into the enclosed fluid, with concave edges and corners.
#pragma once

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

/// Returns a cube [0, 1]^3 of fluid, n squares along each edge; patches x0, x1, y0, y1, z0, z1.
TriMesh cube_room(int n);

/// Returns a room over an isosceles triangle: two sides of length 1 that meet at `angle` (radians) at the origin, from y = 0 to y = length. Patches: lower,
/// upper (the two sides), back, left, right (the triangles). Edges are about 1/n long.
TriMesh wedge_room(double angle, int n, double length = 1.0);

}  // namespace sterna::test
