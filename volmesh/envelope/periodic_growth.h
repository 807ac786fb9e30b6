// Layers that end on periodic sides: the growth at one side must equal the growth at its image on the other side.
#pragma once

#include <vector>

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Gives the vertices of each group (LayerBase::groups) the same direction, the one with the best visibility of the triangles of all, and the lowest of their
/// heights. Both sides of wake sheets (LayerBase::level) get the lower of their heights. Lowers vertices and their partners further where macro-elements are
/// then invalid or, unless `collider` is null, where the top is not clear. Heights only fall, and vertices that still change after some rounds collapse, so the
/// function terminates. It has to be called after every change of heights or directions at open boundaries.
/// \post directions and heights of partners are bit-identical; the envelope is valid, and with a collider also clear. Returns the changed vertices, ascending.
std::vector<VertexId> equalise_partners(const LayerBase& base, const EnvelopeOptions& options, Collider* collider, Envelope& envelope,
                                        const RunContext& context);

}  // namespace sterna::volmesh
