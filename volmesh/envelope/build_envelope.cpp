#include "volmesh/envelope/build_envelope.h"

#include <algorithm>

#include "volmesh/envelope/global_optimisation.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/keep_inside.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/smooth.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

constexpr int k_denoising_sweeps = 3;

}  // namespace

Envelope build_envelope(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context) {
  Collider collider(base, nullptr, context);
  return build_envelope(base, options, collider, context);
}

Envelope build_envelope(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, const RunContext& context) {
  const Classification classes = classify_vertices(base, options, context);
  Envelope envelope = initial_envelope(base, options, context);
  context.progress(0.1);

  smooth_heights(base, classes, options, envelope, context);
  // A few sweeps everywhere take out noise; the many sweeps only where lines converge, so that smooth surfaces keep their normals.
  smooth_directions(base, classes, std::min(options.direction_sweeps, k_denoising_sweeps), envelope, context);
  const Column<VertexId, std::uint8_t> concave = concave_region(base, classes, context);
  smooth_directions(base, classes, options.direction_sweeps, envelope, context, &concave);
  smooth_tangled_regions(base, classes, options, envelope, context);
  keep_inside(base, options, envelope, context);
  context.progress(0.3);

  untangle_edges(base, options, envelope, context);
  unwarp(base, options, HeightLimit::warp, envelope, context);
  smooth_envelope(base, classes, options.envelope_sweeps, envelope, context);
  regrow(base, envelope, context);
  context.progress(0.6);

  share_gaps(base, options, collider, envelope, context);
  retract_collisions(base, options, collider, envelope, context.part("retract", 0.6, 0.8));
  regrow_clear(base, collider, envelope, context);
  optimise_globally(base, options, collider, envelope, context.part("optimise", 0.8, 1.0));
  if (options.optimiser != "none") regrow_clear(base, collider, envelope, context);
  seat_on_surfaces(base, options, &collider, envelope, context);
  return envelope;
}

}  // namespace sterna::volmesh
