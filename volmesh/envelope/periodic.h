// Layers that end on periodic sides: what grows at one side must be what grows at its image on the other.
#pragma once

#include <vector>

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Gives the vertices of each group (LayerBase::groups) the same direction, the one that sees the triangles of all best, and the lowest of their heights, both
/// sides of wake sheets (LayerBase::level) the lower of theirs;
/// lowers further where macro-elements are not valid or (unless `collider` is null) the top is not clear then, and partners with them. Heights only fall; what
/// still changes after some rounds collapses, so it ends. To be called after whatever has changed heights or directions at rims.
/// \post directions and heights of partners equal to the bit; envelope valid, and clear with a collider Returns the vertices that it changed, ascending.
std::vector<VertexId> equalise_partners(const LayerBase& base, const EnvelopeOptions& options, Collider* collider, Envelope& envelope,
                                        const RunContext& context);

}  // namespace sterna::volmesh
