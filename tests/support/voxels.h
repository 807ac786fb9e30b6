// Surfaces of rooms and bodies made of cubes: walls that meet at right angles in all combinations.
#pragma once

#include <array>
#include <functional>

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

/// Returns the boundary of the cubes (i, j, k) of edge length `size`, 0 <= i < n[0] and so on, for which is_fluid holds. Normals point into the fluid; each
/// square is two triangles. `patch_of` receives the middle and normal of a square. Patches are in the order of their first use.
/// \pre no two fluid cubes touch only in an edge or a corner
TriMesh voxel_boundary(const std::array<int, 3>& n, double size, const std::function<bool(int, int, int)>& is_fluid,
                       const std::function<Patch(const Point&, const Vec3&)>& patch_of);

/// Returns a body of four cubes of edge 1 from a 2 x 2 x 2 block, in a chain that turns twice, n squares along each edge; normals out of the body. The vertex
/// (1, 1, 1) has facets of every orientation, so that no direction sees them all.
TriMesh chain_of_cubes(int n);

}  // namespace sterna::test
