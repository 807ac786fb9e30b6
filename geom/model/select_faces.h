// Part of a model by its faces.
#pragma once

#include <functional>

#include "geom/model/model.h"

namespace sterna {

/// Faces for which it holds, with their edges and corners; components and solids of which none is left are gone, a solid that lost some is no longer closed.
Model select_faces(const Model& model, const std::function<bool(FaceId)>& is_chosen);

}  // namespace sterna
