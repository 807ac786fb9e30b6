// Stage 6 of the envelope (docs/method/optimisation.md): runs the optimiser selected by the options and applies its result where the layer stays clear.
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Optimises heights and directions.
/// \pre, \post every macro-element is valid and the envelope is free of self-intersection. If the optimum is not clear, vertices move part of the way.
/// \throws Error(bad_argument) for an unknown optimiser
void optimise_globally(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
