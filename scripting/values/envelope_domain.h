// Layer domain of an envelope whose steps are performed one at a time, on its wall.
#pragma once

#include <memory>

#include "geom/base/run_context.h"
#include "scripting/values/stored_stages.h"
#include "volmesh/parts/joint_envelope.h"

namespace sterna::scripting {

/// Returns the layer domain of a value; the feature angle is the one used for its classification.
std::unique_ptr<volmesh::LayerDomain> envelope_domain(const EnvelopeValue& value, const RunContext& context);

/// Requires that the steps of an envelope are complete. Does nothing for a finished envelope, which is verified later.
/// \throws Error(bad_argument) with the locations and the missing steps if an envelope is not valid and clear yet
void require_ready(const EnvelopeValue& envelope, const volmesh::MeshCase& options, const RunContext& context);

}  // namespace sterna::scripting
