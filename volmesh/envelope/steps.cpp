#include "volmesh/envelope/steps.h"

#include <algorithm>
#include <array>
#include <string>

#include "geom/base/error.h"
#include "volmesh/envelope/global_optimisation.h"
#include "volmesh/envelope/keep_distance.h"
#include "volmesh/envelope/keep_inside.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/set_upright.h"
#include "volmesh/envelope/smooth.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

constexpr int k_denoising_sweeps = 3;
constexpr std::array<std::string_view, 7> k_names = {"classified", "initial", "smoothed", "untangled", "unwarped", "retracted", "finished"};

}  // namespace

std::string_view to_string(EnvelopeStep step) { return k_names[static_cast<std::size_t>(step)]; }

EnvelopeStep envelope_step_of(std::string_view text) {
  const auto found = std::find(k_names.begin(), k_names.end(), text);
  if (found == k_names.end())
    throw Error({.code = ErrorCode::bad_argument, .attempted = "reading an envelope", .problem = "\"" + std::string(text) + "\" is not an envelope step"});
  return static_cast<EnvelopeStep>(found - k_names.begin());
}

void smooth_step(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  smooth_heights(base, classes, options, envelope, context);
  // A few sweeps everywhere remove noise. Many sweeps are made only where growth lines converge, so that growth lines on smooth surfaces stay normal to them.
  smooth_directions(base, classes, std::min(options.direction_sweeps, k_denoising_sweeps), envelope, context);
  const Column<VertexId, std::uint8_t> concave = concave_region(base, classes, context);
  smooth_directions(base, classes, options.direction_sweeps, envelope, context, &concave);
  smooth_tangled_regions(base, classes, options, envelope, context);
  keep_inside(base, options, envelope, context);
}

void untangle_step(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  untangle_edges(base, options, envelope, context);
}

void unwarp_step(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  unwarp(base, options, HeightLimit::warp, envelope, context);
  smooth_envelope(base, classes, options.envelope_sweeps, envelope, context);
  regrow(base, envelope, context);
}

void retract_step(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  share_gaps(base, options, collider, envelope, context);
  retract_collisions(base, options, collider, envelope, context);
  regrow_clear(base, collider, envelope, context);
  keep_distance(base, options, collider, envelope, context);
}

void optimise_step(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  optimise_globally(base, options, collider, envelope, context);
  if (options.optimiser != "none") {
    regrow_clear(base, collider, envelope, context);
    keep_distance(base, options, collider, envelope, context);
  }
  set_upright(base, options, collider, envelope, context);
  seat_on_surfaces(base, options, &collider, envelope, context);
}

}  // namespace sterna::volmesh
