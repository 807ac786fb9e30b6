// Keeps the envelope on the inner side of the constraint surfaces. Keeps constrained vertices on their surfaces.
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Tests an envelope vertex at `growth` from its wall vertex. Returns true if it keeps clear of every surface that applies to the wall vertex and on which the
/// wall vertex does not lie. The required distance is k_kept_share of the wall vertex's own distance or half of k_kept_edges mean edges, whichever is less. For
/// planes, the whole envelope is inside if its vertices are.
bool is_inside(const LayerBase& base, VertexId v, const Vec3& growth);

/// Lowers heights until every vertex is inside. The limit is reported like that of a gap to the mirrored body (HeightLimit::gap).
/// \post is_inside() is true for all vertices
void keep_inside(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);

/// Moves envelope vertices with Freedom::surface onto their surface if the envelope stays valid and clear; otherwise they get a lower height. Directions are
/// chords, so this function has to be called after every change of heights. Without `collider` (null) the caller has to ensure that the envelope is clear. Does
/// nothing if there are no such vertices.
/// \pre the envelope is valid and clear
/// \post the envelope is valid and clear, and every such vertex is on its surface (except for rounding) or collapsed
void seat_on_surfaces(const LayerBase& base, const EnvelopeOptions& options, Collider* collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
