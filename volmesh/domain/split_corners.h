// Patches on which layers end, taken apart at their corners: a box whose sides are one patch.
#pragma once

#include <cstdint>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Where a wall with layers ends on a patch that has sharp edges (more than 40 degrees) at that rim, or at an edge that the patch shares with another one on
/// which layers end, each smooth part of the patch with a rim becomes a patch of its own, with the name and kind of the whole: layers then end on each side of
/// the edge, and in it. Patches are appended; merge_equal_patches() joins the parts of the finished mesh again.
/// \pre boundary closed
/// \post `has_layer` has an entry for each patch
void split_at_corners(TriMesh& boundary, Column<PatchId, std::uint8_t>& has_layer, const RunContext& context);

}  // namespace sterna::volmesh
