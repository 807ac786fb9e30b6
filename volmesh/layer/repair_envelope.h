// Lowers and smooths the envelope around slivers, folds, narrow gaps and reported locations, at which an engine may have failed.
#pragma once

#include <vector>

#include "geom/base/error.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/layer/assemble.h"

namespace sterna::volmesh {

/// Changes the envelope around each triangle of the layer's top that fails the pre-flight check, and around the vertex of the top that is nearest to each of
/// `locations`. Heights become 0.7 of the mean around the defect, with less reduction over four rings. Directions become the mean of the neighbours'
/// directions. Changes are made only where macro-elements stay valid and the top stays clear. The connectivity of the wall is unchanged. \p boundary
/// fill_boundary() of this envelope. \p traits TetraBoundary::traits of this boundary.
/// \pre, \post the envelope is valid and clear. Returns the changed vertices; none if the check finds no defect
std::vector<VertexId> repair_envelope(const LayerBase& base, const FillBoundary& boundary, BoundaryTraits traits, const std::vector<ErrorLocation>& locations,
                                      Collider& collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
