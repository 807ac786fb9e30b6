// Complete construction of the envelope: the steps of docs/method/envelope.md and docs/method/optimisation.md in their order.
#pragma once

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Builds the envelope of the wall.
/// \post every macro-element is valid with margin or collapsed; the envelope is free of self-intersection, and clear of the outer boundary if the Collider has
/// one
Envelope build_envelope(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, const RunContext& context);
Envelope build_envelope(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
