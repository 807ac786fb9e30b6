// Requests in rules of patches that have no effect on this model: errors instead of silence.
#pragma once

#include <cstdint>
#include <span>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// Checks that each request for layers in `options.patches` holds on at least one patch: a number of layers, heights, growth, blend, opened ridges, truncation.
/// A request that a later rule replaces on purpose (by a kind that is no wall, or by layers = 0) is no error. Options of all walls that no wall uses are
/// warnings, also where no wall has layers.
/// \param patches with their kinds (apply_patch_kinds)
/// \param has_layer of each patch: whether it carries layers
/// \throws Error(bad_argument) with all rules in question, the kinds of their patches, and the remedy
void require_used_requests(const Column<PatchId, Patch>& patches, const Column<PatchId, std::uint8_t>& has_layer, const MeshCase& options,
                           const RunContext& context);

}  // namespace sterna::volmesh
