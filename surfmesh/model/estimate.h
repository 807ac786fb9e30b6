// How many triangles sizes ask for, before any is made: absurd sizes end at once.
#pragma once

#include "surfmesh/model/model_sizes.h"

namespace sterna::surfmesh {

/// From the areas of faces and what options and curvature ask for there; narrow places and growth make it more.
double estimated_triangles(const ModelSizes& sizes, FaceId face);

/// \throws Error(overflow) naming the faces that need most, when that is above max_triangles
void check_estimate(const Model& model, const ModelSizes& sizes, const Column<EdgeId, EdgeSamples>& edges, const SurfaceMeshOptions& options);

/// \throws Error(overflow) when the mesh has more than max_triangles
void check_count(const SurfaceMesh& mesh, const SurfaceMeshOptions& options);

}  // namespace sterna::surfmesh
