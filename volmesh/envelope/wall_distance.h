// Fields over the wall whose slope is limited, and with them distances along it.
#pragma once

#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Largest field h <= h0 whose tangential slope is at most `gradient` in every triangle, by fast marching: heights become final from the lowest up, and a
/// vertex is bounded by final ones only, so every height is visited once. With 0 at some vertices, `reach` elsewhere and gradient 1 it becomes the distance
/// along the wall to them, as far as `reach`.
/// Based on: Kimmel & Sethian 1998.
void limit_gradient(const LayerBase& base, double gradient, Column<VertexId, double>& height);

}  // namespace sterna::volmesh
