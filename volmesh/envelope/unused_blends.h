// Blends of layers that are requested but have no effect on this model.
#pragma once

#include <span>

#include "geom/base/run_context.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/first_heights.h"
#include "volmesh/case/layer_rules.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Warns of each rule whose `blend` has no effect, because no patch of the rule is adjacent to a patch whose layers differ in first height, growth, height or
/// thickness.
/// \pre the same as for demand_of
void warn_of_unused_blends(const LayerBase& base, const EnvelopeOptions& options, std::span<const Rule> rules, const FirstHeights* by_location,
                           const RunContext& context);

}  // namespace sterna::volmesh
