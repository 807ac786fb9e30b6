// The envelope from start to end: the list of steps of method.md §§1-6.
#pragma once

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// \post every macro-element valid with margin (or collapsed), envelope free of self-intersection.
Envelope build_envelope(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
