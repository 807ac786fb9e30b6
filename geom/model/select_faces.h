// Selects part of a model by its faces.
#pragma once

#include <functional>

#include "geom/model/model.h"

namespace sterna {

/// Returns the faces for which `is_chosen` is true, with their edges and corners. Components and solids without remaining faces are removed; a solid that lost
/// some faces is no longer closed.
Model select_faces(const Model& model, const std::function<bool(FaceId)>& is_chosen);

}  // namespace sterna
