// Keeps the envelope on the inner side of the constraint surfaces, and the vertices that are on one, on it.
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Whether an envelope vertex at `growth` from its wall vertex keeps clear of every surface that concerns the wall vertex and that it is not on: at least 5 %
/// of the wall vertex's own distance. For planes this holds for the whole envelope when it holds at its vertices.
bool is_inside(const LayerBase& base, VertexId v, const Vec3& growth);

/// Lowers heights until every vertex is inside, as the gap to the mirrored body would ask (HeightLimit::gap).
/// \post is_inside() everywhere.
void keep_inside(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);

/// Moves envelope vertices with Freedom::surface onto their surface where the envelope stays valid and clear; where it does not, lower. Directions are chords,
/// so this has to follow whatever changed heights. Without `collider` (may be null) clearance is left to the caller. Does nothing without such vertices.
/// \pre envelope valid and clear.
/// \post the same, and every such vertex on its surface to rounding or collapsed.
void seat_on_surfaces(const LayerBase& base, const EnvelopeOptions& options, Collider* collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
