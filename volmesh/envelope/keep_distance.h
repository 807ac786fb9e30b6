// Room for tetrahedra: keeps the top of the layer at a distance from opposing surfaces (docs/method/envelope.md, "Room for tetrahedra").
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Lowers heights on both sides where the top is too near to an opposing part of the top or to an opposing wall. The required distance is min(k_kept_edges
/// edges, k_kept_share of the gap between the walls) (layer_room.h). Half of this distance is kept from the outer boundary, because a mirrored layer may be on
/// its other side. `cap` is also lowered, so that no later step raises the heights again. Triangles at the vertex itself or its neighbours are not tested,
/// because the fold limits of the envelope apply to them.
/// \pre, \post macro-elements are valid, and the top is clear (retract.h)
void keep_distance(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
