// How near faces are that look at each other: across gaps, and through thin parts.
#pragma once

#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/surface_sizes.h"

namespace sterna::surfmesh {

/// Sizes that gaps and thin parts ask for, as sources on the faces beside them: a gap divided by `gap_cells`, `thickness_factor` times a thickness, at least
/// min_edge. Measured by rays along normals of a coarse triangulation, the cells of `field` (about two edges long), to triangles that face them within 30
/// degrees. Does nothing when neither is asked for.
/// \pre field keeps its grids
void add_gap_sources(const Model& model, const SurfaceSizes& field, const SurfaceMeshOptions& options, ModelSizes& sizes, const RunContext& context);

/// Whether the options ask for it.
bool looks_for_gaps(const SurfaceMeshOptions& options);

}  // namespace sterna::surfmesh
