// Surfaces of rooms and bodies made of cubes: walls that meet at right angles in every way.
#pragma once

#include <array>
#include <functional>

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

/// Boundary of the cubes (i, j, k) of edge length `size`, 0 <= i < n[0] and so on, for which is_fluid holds; normals into the fluid; every square is two
/// triangles. `patch_of`: of a square's middle and normal. Patches in the order in which they appear.
/// \pre no two fluid cubes touch in an edge or a corner alone
TriMesh voxel_boundary(const std::array<int, 3>& n, double size, const std::function<bool(int, int, int)>& is_fluid,
                       const std::function<Patch(const Point&, const Vec3&)>& patch_of);

/// A body: four cubes of edge 1 of a 2 x 2 x 2 block, in a chain that turns twice, n squares along each edge; normals out of the body. At the vertex (1, 1, 1)
/// there are facets of every sense, so that no direction sees them all.
TriMesh chain_of_cubes(int n);

}  // namespace sterna::test
