// Fields on the wall with limited slope, and distances along the wall that are computed with them.
#pragma once

#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Computes the largest field h <= h0 whose tangential slope is at most `gradient` in every triangle. Uses fast marching: heights become final in ascending
/// order, and only final vertices limit other vertices, so every height is visited once. With gradient 1, h0 = 0 at some vertices and h0 = `reach` at all
/// others, the field becomes the distance along the wall to these vertices, up to `reach`. Based on: Kimmel & Sethian 1998.
void limit_gradient(const LayerBase& base, double gradient, Column<VertexId, double>& height);

}  // namespace sterna::volmesh
