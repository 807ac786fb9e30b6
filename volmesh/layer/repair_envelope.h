// Lowers and smooths the envelope around slivers, folds, narrow gaps and reported locations where an engine may have failed.
#pragma once

#include <vector>

#include "geom/base/error.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/layer/assemble.h"

namespace sterna::volmesh {

/// Changes the envelope around each triangle of the layer's top that fails the pre-flight check, and around the vertex of the top that is nearest to each of
/// `places`. Heights go to 0.7 of the mean around, decreasingly over four rings, and directions to the mean of their neighbours' directions, wherever
/// macro-elements stay valid and the top stays clear. Wall connectivity is kept. \p boundary: fill_boundary() of this envelope; \p has_sheets:
/// TetraBoundary::has_sheets of it.
/// \pre, \post envelope valid and clear. Returns the vertices that it changed; none if the check finds no defect.
std::vector<VertexId> repair_envelope(const LayerBase& base, const FillBoundary& boundary, bool has_sheets, const std::vector<ErrorPlace>& places,
                                      Collider& collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
