// The envelope of a separate part of the wall, in the frame in which the part was meshed. It does not depend on the placement and the surroundings of the part.
#pragma once

#include <functional>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/layer_rules.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/parts/warm_start.h"

namespace sterna::volmesh {

/// Complete input of a part's envelope.
struct PartEnvelopeTask {
  TriMesh wall;  ///< wall in the part's own frame; its patches have kinds, and all of them carry layers
  EnvelopeOptions options;
  std::vector<Rule> rules;            ///< rules whose name matches a patch of the part
  double smooth_angle = k_automatic;  ///< rad: MeshCase::smooth_angle of the part
};

struct PartEnvelope {
  Envelope envelope;
  double feature_angle = 0.0;  ///< rad, given by the user or detected for this part
};

/// Runs build_envelope() for the part without its surroundings. If `make` is set, runs `make` instead.
/// \pre the wall is closed
/// \throws Error(self_intersection) if the part crosses itself; errors of the stages
PartEnvelope part_envelope(const PartEnvelopeTask& task, const RunContext& context, const WallEnvelopeMaker& make = {});

/// Makes such envelopes. It is part_envelope(), or a function that returns known envelopes.
using PartEnvelopeMaker = std::function<PartEnvelope(const PartEnvelopeTask&, const RunContext&)>;

}  // namespace sterna::volmesh
