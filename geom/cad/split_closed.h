// Inside geom/cad only: splits faces on closed surfaces into halves without seams.
#pragma once

#include <optional>

#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna::cad {

/// Returns the model with each face that has a seam split along the seam and half a turn away; names, roles, kinds and components are kept. Returns nothing if
/// no face has a seam, if OpenCASCADE fails, or if the result differs: areas and volumes to 1e-6, no new free edge.
/// \throws errors of shape_of, Error(cancelled)
std::optional<Model> split_closed_faces(const Model& model, const RunContext& context);

}  // namespace sterna::cad
