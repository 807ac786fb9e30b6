#include "volmesh/envelope/build_envelope.h"

#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/steps.h"

namespace sterna::volmesh {

Envelope build_envelope(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context) {
  Collider collider(base, nullptr, context);
  return build_envelope(base, options, collider, context);
}

Envelope build_envelope(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, const RunContext& context) {
  const Classification classes = classify_vertices(base, options, context);
  Envelope envelope = initial_envelope(base, options, context);
  context.progress(0.1);
  smooth_step(base, classes, options, envelope, context);
  context.progress(0.3);
  untangle_step(base, options, envelope, context);
  unwarp_step(base, classes, options, envelope, context);
  context.progress(0.6);
  retract_step(base, options, collider, envelope, context.part("retract", 0.6, 0.8));
  optimise_step(base, options, collider, envelope, context.part("optimise", 0.8, 1.0));
  return envelope;
}

}  // namespace sterna::volmesh
