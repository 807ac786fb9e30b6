// Steps of the driver from the domain to the layer.
#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/number_text.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/periodic_growth.h"
#include "volmesh/forecast.h"
#include "volmesh/layer/repair_envelope.h"
#include "volmesh/parts/joint_envelope.h"
#include "volmesh/run_steps.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_boundary_repairs = 3;

void report_slivers(const SliverReport& slivers, const SliverOptions& options, const RunContext& context) {
  if (slivers.has_changed()) context.debug(describe(slivers));
  if (slivers.n_left == 0) return;
  std::string hint;
  if (options.needle_budget == 0.0) hint = "; needle_budget = 1 splits the slivers that can be improved";
  if (slivers.is_over_budget) hint = "; a larger needle_budget splits more slivers";
  context.warn(std::to_string(slivers.n_left) + " triangles of the wall have an angle below " +
               number_text(options.split_needles * 180.0 / std::numbers::pi, 3) + " degrees (slivers" + (slivers.has_changed() ? " that are left" : "") +
               "); the first one is at " + format_point(slivers.first_left) + hint);
}

EnvelopeStage envelope_of(LayerDomain& layer_domain, const Makers& makers, const RunContext& context) {
  const StageTimer timer(context, "envelope");
  const RunContext part = part_of_run(RunStep::envelope, context);
  require_room(forecast_of(layer_domain), layer_domain.options.limits, context);
  report_slivers(layer_domain.domain.slivers, layer_domain.options.needles, context);
  const std::vector<WholePart> parts = !layer_domain.domain.needs.has_own_wall
                                           ? whole_parts(layer_domain.domain, layer_domain.options.parts, context)
                                           : std::vector<WholePart>{};  // walls that are cut or opened no longer belong to placed parts
  const auto of_wall = [&] {
    const WallEnvelopeMaker& make = makers.wall_envelope;
    return make ? make(layer_domain.base, layer_domain.options.envelope, layer_domain.collider, part)
                : build_envelope(layer_domain.base, layer_domain.options.envelope, layer_domain.collider, part);
  };
  EnvelopeStage stage{parts.empty() ? of_wall() : joint_envelope(layer_domain, parts, makers.part_envelope, part), layer_domain.options.envelope.feature_angle};
  equalise_partners(layer_domain.base, layer_domain.options.envelope, &layer_domain.collider, stage.envelope, context);
  return stage;
}

}  // namespace

void domain_step(MeshRun& run, const RunContext& context) {
  MeshCase options = with_closed_multi_normals(run.options, run.closed);
  if (run.given) options.envelope.feature_angle = run.given->feature_angle;
  run.layer_domain.emplace(run.surface, options, context, run.closed.base_vertices);
}

void envelope_step(MeshRun& run, const RunContext& context) {
  const StageWatch& watch = run.watch;
  const auto make = [&] { return envelope_of(*run.layer_domain, run.makers, context); };
  run.envelope = run.given ? *std::move(run.given) : watch.envelope && run.closed.n_rounds == 0 ? watch.envelope(make) : make();
  run.given.reset();  // the given envelope belongs to the wall of this round only
  run.envelope.closed = run.closed;
  if (watch.enveloped) watch.enveloped(run.envelope);
  require_same(run.envelope.envelope.height.size(), run.layer_domain->base.wall.n_vertices(), "vertices of the envelope");
}

void layer_step(MeshRun& run, const RunContext& context) {
  const bool is_first = run.round.n_repairs == 0;
  run.layer = lay_out(*run.layer_domain, run.envelope.envelope, is_first ? part_of_run(RunStep::layer, context) : context);
  if (is_first) warn_of_layer(run, context);
}

void warn_of_layer(MeshRun& run, const RunContext& context) {
  std::vector<std::string>& reported = run.round.reported;
  for (const std::string& warning : run.layer.report.warnings)
    if (std::ranges::find(reported, warning) == reported.end()) context.warn(reported.emplace_back(warning));
}

bool repair_for_engines(MeshRun& run, const FillError& error, const RunContext& context) {
  RunRound& round = run.round;
  round.failures.insert(round.failures.end(), error.failures().begin(), error.failures().end());
  if (!run.layer_domain || round.n_repairs++ == k_max_boundary_repairs) return false;
  LayerDomain& layer_domain = *run.layer_domain;
  if (!layer_domain.options.tetrahedra.repair_boundary || !error.is_repeatable()) return false;
  const std::size_t n_changed = repair_envelope(layer_domain.base, run.layer.boundary, layer_domain.domain.needs.traits, error.info().locations,
                                                layer_domain.collider, run.envelope.envelope, context)
                                    .size();
  if (n_changed == 0) return false;
  context.warn("trying again with the layer lowered and smoothed at " + std::to_string(n_changed) +
               " vertices around slivers, folds and gaps of the layer top");
  return true;
}

}  // namespace sterna::volmesh
