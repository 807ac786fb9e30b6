// Selection of patches for pictures of bodies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

/// Returns one flag per patch: true for an outer wall, that is, a wall that encloses the fluid and the walls of bodies from outside, such as a tunnel wall.
/// Seen from most of the area of such a patch, the whole boundary is on the fluid side; its box is a large part of the box of the boundary; and the box of all
/// outer walls contains the other walls. No flag is set if all walls are outer walls: in a duct nothing else is visible.
std::vector<std::uint8_t> outer_walls(const HybridMesh& mesh);

/// Returns one flag per patch: true for walls, and for inflow and outflow faces that belong to a body (fan faces, nozzles). Such faces lie within the box of
/// all walls and are small compared with it. Without walls all flags are set.
/// \p boxes: boxes of the patches' points; \p is_outer: walls to be ignored, by patch; empty: none
std::vector<std::uint8_t> patches_of_bodies(const Column<PatchId, Patch>& patches, std::span<const Box> boxes, std::span<const std::uint8_t> is_outer = {});
/// Returns the flags for a mesh, ignoring its outer_walls().
std::vector<std::uint8_t> patches_of_bodies(const HybridMesh& mesh);

/// Returns the surface as the boundary of a mesh without cells. Triangles of surfaces point into the fluid, boundary faces out of it.
HybridMesh boundary_of(const TriMesh& surface);

}  // namespace sterna
