// An envelope whose steps are made one by one, on the wall where it stands.
#pragma once

#include <memory>

#include "geom/base/run_context.h"
#include "scripting/values/stages.h"
#include "volmesh/parts/joint_envelope.h"

namespace sterna::scripting {

/// The site of a value; the feature angle is the one that it was classified with.
std::unique_ptr<volmesh::MeshingSite> envelope_site(const EnvelopeValue& value, const RunContext& context);

/// \throws Error(bad_argument) with the places, and the steps that are missing, where an envelope is not valid and clear yet. Nothing to do for a finished one,
/// which is proved later.
void require_ready(const EnvelopeValue& envelope, const volmesh::MeshCase& options, const RunContext& context);

}  // namespace sterna::scripting
