// The envelope of a separate part of the wall, in the frame in which the part was meshed: independent of its placement and surroundings.
#pragma once

#include <functional>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/patch_rule.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/parts/warm_start.h"

namespace sterna::volmesh {

/// Complete input of a part's envelope.
struct PartEnvelopeTask {
  TriMesh wall;  ///< in the part's own frame; patches with their kinds, all of them with layers
  EnvelopeOptions options;
  std::vector<PatchRule> rules;       ///< rules whose name matches a patch of the part
  double smooth_angle = k_automatic;  ///< rad: MeshCase::smooth_angle of the part
};

struct PartEnvelope {
  Envelope envelope;
  double feature_angle = 0.0;  ///< rad, user-defined or detected for this part
};

/// Runs build_envelope() for the part without surroundings, or `make` in its place.
/// \pre wall closed
/// \throws Error(self_intersection) if the part crosses itself; errors of the stages
PartEnvelope part_envelope(const PartEnvelopeTask& task, const RunContext& context, const WallEnvelopeMaker& make = {});

/// Makes such envelopes: part_envelope(), or a function that returns known ones.
using PartEnvelopeMaker = std::function<PartEnvelope(const PartEnvelopeTask&, const RunContext&)>;

}  // namespace sterna::volmesh
