// Distances between faces that face each other: across gaps, and through thin parts.
#pragma once

#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/surface_sizes.h"

namespace sterna::surfmesh {

/// Adds the sizes required by gaps and thin parts, as sources on the adjacent faces. The size is the width of a gap divided by `gap_cells`, or
/// `thickness_factor` times a thickness, and at least min_edge. Distances are measured by rays along normals of a coarse triangulation, the cells of `field`
/// (about two edges long), to triangles that face them within 30 degrees. Does nothing if neither option is set.
/// \pre `field` keeps its grids
void add_gap_sources(const Model& model, const SurfaceSizes& field, const SurfaceMeshOptions& options, ModelSizes& sizes, const RunContext& context);

/// Returns true if the options require sizes from gaps or thicknesses.
bool looks_for_gaps(const SurfaceMeshOptions& options);

}  // namespace sterna::surfmesh
