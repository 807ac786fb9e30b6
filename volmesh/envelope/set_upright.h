// Turns growth lines whose inclination to a facet normal makes flat cells there unsuitable for solvers (docs/heights.md).
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Turns growth lines towards the direction with the best visibility of all facets. This is done where flat cells above a facet are inclined by more than 75
/// degrees and the growth line itself by more than 78 degrees, as far as the envelope stays valid and clear. A growth line may lose up to 0.6 of its height
/// through this, which is reported as HeightLimit::warp. Does nothing if growth lines have their own growth (growth = "local"). \pre, \post the envelope is
/// valid and clear
void set_upright(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
