// Which patches a picture of bodies shows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/mesh/tri_mesh.h"

namespace sterna {

/// One flag for each patch: walls, and faces through which fluid enters or leaves that belong to a body (fan faces, nozzles): within the box of all walls, and
/// small beside it. Without walls: all.
/// \p boxes: of the patches' points
std::vector<std::uint8_t> patches_of_bodies(const Column<PatchId, Patch>& patches, std::span<const Box> boxes);

}  // namespace sterna
