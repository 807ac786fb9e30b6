// Splits patches on which layers end at their sharp edges. An example is a box whose sides are one patch.
#pragma once

#include <cstdint>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Splits patches with sharp edges (more than 40 degrees) at a layer boundary, or at an edge shared with another patch on which layers end. Each smooth part of
/// the patch that has a layer boundary becomes a separate patch, with the name and kind of the original patch. Layers then end on the parts on both sides of
/// the edge, and in the edge. Patches are appended; merge_equal_patches() joins the parts of the finished mesh again.
/// \pre the boundary is closed
/// \post `has_layer` has an entry for each patch
void split_at_corners(TriMesh& boundary, Column<PatchId, std::uint8_t>& has_layer, const RunContext& context);

}  // namespace sterna::volmesh
