// The envelope of a part of the wall alone, in the frame in which it was meshed: the same wherever the part is and whatever is around it.
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

/// Everything that a part's envelope depends on.
struct PartEnvelopeTask {
  TriMesh wall;  ///< in the part's own frame; patches with their kinds, all of them with layers
  EnvelopeOptions options;
  std::vector<PatchRule> rules;       ///< those that a patch of it is named like
  double smooth_angle = k_automatic;  ///< rad: MeshCase::smooth_angle of the part
};

struct PartEnvelope {
  Envelope envelope;
  double feature_angle = 0.0;  ///< rad, the user's or the one found for this part
};

/// build_envelope() of the part with nothing around it, or what `make` makes in its place.
/// \pre wall closed
/// \throws Error(self_intersection) where the part crosses itself; of the stages
PartEnvelope part_envelope(const PartEnvelopeTask& task, const RunContext& context, const WallEnvelopeMaker& make = {});

/// Who makes such envelopes: part_envelope(), or one who knows some already.
using PartEnvelopeMaker = std::function<PartEnvelope(const PartEnvelopeTask&, const RunContext&)>;

}  // namespace sterna::volmesh
