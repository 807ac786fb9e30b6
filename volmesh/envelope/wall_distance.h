// Fields over the wall with limited slope, and distances along the wall computed with them.
#pragma once

#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Computes the largest field h <= h0 whose tangential slope is at most `gradient` in every triangle, by fast marching: heights become final in ascending
/// order, and a vertex is bounded by final vertices only, so every height is visited once. With 0 at some vertices, `reach` elsewhere and gradient 1 the
/// field becomes the distance along the wall to these vertices, as far as `reach`.
/// Based on: Kimmel & Sethian 1998.
void limit_gradient(const LayerBase& base, double gradient, Column<VertexId, double>& height);

}  // namespace sterna::volmesh
