// The envelope from start to end: the list of steps of docs/method/envelope.md and docs/method/optimisation.md.
#pragma once

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// \post every macro-element valid with margin (or collapsed), envelope free of self-intersection.
/// With a Collider that knows an outer boundary, clear of that too.
Envelope build_envelope(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, const RunContext& context);
Envelope build_envelope(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
