// Estimate of the number of triangles before meshing, to reject unreasonable sizes early.
#pragma once

#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/wing_bands.h"

namespace sterna::surfmesh {

/// Returns an estimate from the areas of faces and the sizes that options and curvature require there. Narrow regions and limited growth add to the number.
double estimated_triangles(const ModelSizes& sizes, FaceId face);

/// \throws Error(overflow) naming the faces that need most, if the estimate is above max_triangles
void check_estimate(const Model& model, const ModelSizes& sizes, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options);

/// Checks the estimate for the columns of bands alone.
/// \throws Error(overflow) naming the edge's face
void check_band_estimate(const Model& model, const WingBands& bands, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options);

/// \throws Error(overflow) when the mesh has more than max_triangles; Error(bad_argument) when it has none, because all faces were absorbed
void check_count(const SurfaceMesh& mesh, const SurfaceMeshOptions& options);

}  // namespace sterna::surfmesh
