// Keeps the envelope on the inner side of the constraint surfaces, and constrained vertices on their surfaces.
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Returns true if an envelope vertex at `growth` from its wall vertex keeps clear of every surface that applies to the wall vertex and on which the wall
/// vertex does not lie: at least k_kept_share of the wall vertex's own distance or half of k_kept_edges mean edges, whichever is less. For planes this holds
/// for the whole envelope if it holds at its vertices.
bool is_inside(const LayerBase& base, VertexId v, const Vec3& growth);

/// Lowers heights until every vertex is inside, as for a gap to the mirrored body (HeightLimit::gap).
/// \post is_inside() everywhere.
void keep_inside(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);

/// Moves envelope vertices with Freedom::surface onto their surface where the envelope stays valid and clear; elsewhere at a lower height. Directions are
/// chords, so this function has to be called after every change of heights. Without `collider` (may be null) clearance is left to the caller. Does nothing
/// without such vertices.
/// \pre envelope valid and clear.
/// \post the same, and every such vertex on its surface to rounding or collapsed.
void seat_on_surfaces(const LayerBase& base, const EnvelopeOptions& options, Collider* collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
