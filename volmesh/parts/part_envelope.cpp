#include "volmesh/parts/part_envelope.h"

#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/envelope/feature_angle.h"
#include "volmesh/envelope/patch_layers.h"

namespace sterna::volmesh {

PartEnvelope part_envelope(const PartEnvelopeTask& task, const RunContext& context, const WallEnvelopeMaker& make) {
  LayerBase base(task.wall, context);
  base.demand = demand_of(base, task.options, task.rules, nullptr, context);
  EnvelopeOptions options = task.options;
  options.feature_angle = decide_feature_angle(base, options, task.smooth_angle, context);
  Collider collider(base, nullptr, context);
  require_clear_input(collider, context);
  return {make ? make(base, options, collider, context) : build_envelope(base, options, collider, context), options.feature_angle};
}

}  // namespace sterna::volmesh
