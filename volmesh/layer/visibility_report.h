// How well the wall's vertices see their faces: whether one growth direction can serve them all.
#pragma once

#include "volmesh/envelope/layer_base.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {

VisibilityReport report_visibility(const LayerBase& base);

}  // namespace sterna::volmesh
