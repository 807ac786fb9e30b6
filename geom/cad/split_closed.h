// Inside geom/cad only: faces on closed surfaces as halves, without seams.
#pragma once

#include <optional>

#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna::cad {

/// The same model with each face that has a seam split along it and half a turn away; names, roles, kinds and components stay. Nothing where no face has a
/// seam, where OpenCASCADE fails, or where the result is not the same: areas and volumes to 1e-6, no free edge that was none.
/// \throws Error of shape_of, Error(cancelled)
std::optional<Model> split_closed_faces(const Model& model, const RunContext& context);

}  // namespace sterna::cad
