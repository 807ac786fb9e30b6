// Which patches a picture of bodies shows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

/// One flag for each patch: whether it is a wall that encloses the fluid from outside, as a tunnel's do, beside walls of bodies within. Most of the area of
/// such a patch has all of the boundary on its fluid side, and its box is a good part of that of the boundary; the box of all outer walls contains the other
/// walls. No flags where all walls are outer walls: in a duct nothing else can be seen.
std::vector<std::uint8_t> outer_walls(const HybridMesh& mesh);

/// One flag for each patch: walls, and faces through which fluid enters or leaves that belong to a body (fan faces, nozzles): within the box of all walls, and
/// small beside it. Without walls: all.
/// \p boxes: of the patches' points; \p is_outer: walls that do not count, by patch; empty: none
std::vector<std::uint8_t> patches_of_bodies(const Column<PatchId, Patch>& patches, std::span<const Box> boxes, std::span<const std::uint8_t> is_outer = {});
/// The same of a mesh, without its outer_walls().
std::vector<std::uint8_t> patches_of_bodies(const HybridMesh& mesh);

/// The surface as the boundary of a mesh without cells. Triangles of surfaces point into the fluid, boundary faces out of it.
HybridMesh boundary_of(const TriMesh& surface);

}  // namespace sterna
