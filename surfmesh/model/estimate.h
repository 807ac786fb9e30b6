// Estimates the number of triangles before meshing, so that unreasonable sizes are rejected early.
#pragma once

#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/wing_bands.h"

namespace sterna::surfmesh {

/// Returns an estimate from the area of the face and the sizes that options and curvature require on it. Narrow regions and limited growth increase the actual
/// number.
double estimated_triangles(const ModelSizes& sizes, FaceId face);

/// \throws Error(overflow) naming the faces that need most, if the estimate is above max_triangles
void check_estimate(const Model& model, const ModelSizes& sizes, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options);

/// Checks the estimate for the columns of bands alone.
/// \throws Error(overflow) naming the edge's face
void check_band_estimate(const Model& model, const WingBands& bands, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options);

/// \throws Error(overflow) if the mesh has more than max_triangles; Error(bad_argument) if it has none because all faces were absorbed
void check_count(const SurfaceMesh& mesh, const SurfaceMeshOptions& options);

}  // namespace sterna::surfmesh
