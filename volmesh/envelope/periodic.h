// Layers that end on periodic sides: growth at one side must equal the growth at its image on the other.
#pragma once

#include <vector>

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Gives the vertices of each group (LayerBase::groups) the same direction, namely the one with the best visibility of the triangles of all, and the lowest
/// of their heights; both sides of wake sheets (LayerBase::level) get the lower of their heights. Lowers further, together with all partners, where
/// macro-elements are invalid or (unless `collider` is null) the top is not clear afterwards. Heights only fall; vertices that still change after some rounds
/// collapse, so the function terminates. To be called after every change of heights or directions at open boundaries.
/// \post directions and heights of partners equal to the bit; envelope valid, and clear with a collider. Returns the vertices that it changed, ascending.
std::vector<VertexId> equalise_partners(const LayerBase& base, const EnvelopeOptions& options, Collider* collider, Envelope& envelope,
                                        const RunContext& context);

}  // namespace sterna::volmesh
