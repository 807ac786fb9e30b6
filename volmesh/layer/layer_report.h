// What became of the layer, measured against h_target (method.md §2).
#pragma once

#include "volmesh/envelope/envelope.h"
#include "volmesh/layer/extrude.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {

LayerReport report_layer(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope, const Extrusion& extrusion,
                         const RunContext& context);

/// What was asked of each line, for the gates of `check`.
LayerRequest layer_request(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope);

}  // namespace sterna::volmesh
