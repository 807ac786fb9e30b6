// Room for the tetrahedra: the top of the layer keeps a real distance from what it faces (docs/method/envelope.md, "Room for tetrahedra").
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Lowers heights on both sides where the top is nearer than min(k_kept_edges edges, k_kept_share of the gap between the walls) (layer_room.h) to another part
/// of the top, or to the wall, that faces it; than half of that to the outer boundary, on whose other side a mirrored layer may be. Limits `cap`, too, so that
/// nothing grows back. Triangles at the vertex itself or its neighbours are no part of this: there the folds of the envelope decide.
/// \pre, \post macro-elements valid, the top clear (retract.h).
void keep_distance(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
