// How many triangles sizes ask for, before any is made: absurd sizes end at once.
#pragma once

#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/wing_bands.h"

namespace sterna::surfmesh {

/// From the areas of faces and what options and curvature ask for there; narrow places and growth make it more.
double estimated_triangles(const ModelSizes& sizes, FaceId face);

/// \throws Error(overflow) naming the faces that need most, when that is above max_triangles
void check_estimate(const Model& model, const ModelSizes& sizes, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options);

/// The same for columns of bands alone.
/// \throws Error(overflow) naming the edge's face
void check_band_estimate(const Model& model, const WingBands& bands, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options);

/// \throws Error(overflow) when the mesh has more than max_triangles; Error(bad_argument) when it has none, because all faces were absorbed
void check_count(const SurfaceMesh& mesh, const SurfaceMeshOptions& options);

}  // namespace sterna::surfmesh
