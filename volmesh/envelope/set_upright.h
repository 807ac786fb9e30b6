// Lines that lean so far above a facet that its flat cells are unfit for solvers (docs/heights.md).
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Turns lines towards the direction that sees all facets best, where flat cells above a facet lean by more than 75 degrees and the line itself by more than
/// 78, as far as the envelope stays valid and clear; a line may lose up to 0.6 of its height for it, which is told as HeightLimit::warp. Does nothing where
/// lines have their own growth (growth = "local"). \pre, \post valid and clear.
void set_upright(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
