// Step of the driver that makes the tetrahedra around a layer.
#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/alongside.h"
#include "geom/base/error.h"
#include "volmesh/forecast.h"
#include "volmesh/layer/split_layer.h"
#include "volmesh/run_steps.h"
#include "volmesh/tetra/size_supply.h"

namespace sterna::volmesh {
namespace {

/// Adapts the true surface of the user's surface to the triangles of the wall.
TrueSurface true_surface_of(const TrueSurface& of_surface, const Domain& domain) {
  if (!of_surface) return {};
  return [of_surface, &domain](const Point& p, TriangleId t, const std::array<double, 3>& weights) {
    if (domain.wall_weights.empty()) return of_surface(p, domain.wall2surface[t], weights);
    std::array<double, 3> in_given{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 3; ++j) in_given[j] += weights[k] * domain.wall_weights[t][k][j];
    const bool is_of_one = std::ranges::any_of(in_given, [](double weight) { return weight != 0.0; });
    return is_of_one ? of_surface(p, domain.wall2surface[t], in_given) : p;
  };
}

/// Result of one attempt to make the tetrahedra.
struct Filling {
  TetraResult tets;
  std::optional<SplitLayer> split;  ///< set if the engine has split triangles: the layer with the same splits
  std::optional<LayerProof> proof;  ///< verification of the layer that the tetrahedra surround
  std::vector<Point> holes;
  ClearProof clear;  ///< proof for the boundary
};

/// Fills the volume inside the split boundary again, which is now kept, after the layer had to be lowered for the splits.
void refill(const SplitLayer& layer, const MeshCase& options, TetraResult& tets, const RunContext& context) {
  TetraOptions keeping = options.tetrahedra;
  keeping.boundary_splits = "never";
  const std::vector<Point> holes = find_cavity_points(*layer.wall, context);
  const TetraBoundary domain = engine_boundary(layer.boundary, holes, layer.clear, {});
  SizeSupply sizes(domain, options.sources, options.size, context);
  tets = fill(domain, sizes, keeping, context);
}

/// Takes the first candidate of the engines whose splits can be applied to the layer.
void climb(const LayerDomain& layer_domain, const Envelope& envelope, const Makers& makers, TetraLadder& ladder, Filling& filling, const RunContext& context) {
  const TrueSurface true_surface = true_surface_of(makers.true_surface, layer_domain.domain);
  for (;;) {
    filling.tets = ladder.next();
    if (filling.tets.splits.empty()) return;
    try {
      filling.split = split_layer(layer_domain.base, envelope, layer_domain.domain.outer, layer_domain.options, true_surface, filling.tets, context);
      if (!filling.split->is_filled) refill(*filling.split, layer_domain.options, filling.tets, context);
      return;
    } catch (const Error& error) {
      filling.split.reset();
      ladder.reject(error);
    }
  }
}

/// Makes the tetrahedra around a layer, and verifies the layer in parallel. \throws FillError
Filling fill_around(const LayerDomain& layer_domain, const Envelope& envelope, const LaidLayer& layer, const Makers& makers, const RunContext& context) {
  const StageTimer timer(context, "tetrahedra");
  Filling filling;
  const Domain& domain = layer_domain.domain;
  const SplitPermission splits = domain.wall.n_triangles() > 0 && !domain.needs.keeps_boundary ? SplitPermission::permitted : SplitPermission::never;
  filling.holes = find_cavity_points(domain.bodies, context);
  const TetraBoundary boundary = engine_boundary(layer.boundary, filling.holes, layer.clear, domain.needs.traits);
  const CellCounts cells = count_cells(layer.mesh);
  Forecast forecast{.n_triangles = static_cast<double>(layer_domain.base.wall.n_triangles()), .n_prisms = static_cast<double>(cells.total())};
  SizeSupply sizes(boundary, layer_domain.options.sources, layer_domain.options.size, context, [&](const SizeField& field, const RunContext& side) {
    forecast.n_tetrahedra = expected_tetrahedra(field);
    require_room(forecast, layer_domain.options.limits, side);
  });
  TetraLadder ladder(boundary, &sizes, layer_domain.options.tetrahedra, splits, part_of_run(RunStep::tetrahedra, context));
  filling.clear = ladder.proof();
  Alongside<LayerProof> proof(context, ladder.begins_here() ? context.threads() : context.threads() - 1, [&sizes, &layer](const RunContext& side) {
    sizes.wait();  // the verification waits, because the engine needs the sizes sooner
    return prove_layer(layer.mesh, side);
  });
  climb(layer_domain, envelope, makers, ladder, filling, context);
  filling.proof.emplace(std::move(proof).take());
  return filling;
}

/// Replaces the layer by its split version.
LaidLayer adopted(SplitLayer& split, const LaidLayer& unsplit, const EnvelopeOptions& options, const RunContext& context) {
  context.info("boundary splits: " + std::to_string(split.boundary.points.size() - unsplit.boundary.points.size()) + " new points, " +
               std::to_string(split.boundary.triangles.size() - unsplit.boundary.triangles.size()) + " more triangles");
  LaidLayer layer;
  layer.certificate = split.certificate;
  layer.clear = split.clear;
  layer.report = report_layer(*split.base, options, split.envelope, split.extrusion, split.outer.get(), context);
  layer.curving_shares = split.extrusion.curving_shares;
  layer.mesh = assemble_layers(*split.base, std::move(split.extrusion), unlinked(*split.outer), {});
  layer.mesh.request = layer_request(*split.base, options, split.envelope, layer.mesh.layers);
  layer.boundary = std::move(split.boundary);
  return layer;
}

/// Takes over the split layer, if the engine has split triangles of the boundary.
void take_splits(Filling& filling, MeshRun& run, const RunContext& context) {
  if (!filling.split) return;
  SplitLayer& split = *filling.split;
  run.filled.n_split_triangles = static_cast<std::int64_t>(split.boundary.triangles.size() - run.layer.boundary.triangles.size());
  run.layer = adopted(split, run.layer, run.layer_domain->options.envelope, context);
  filling.proof.emplace(prove_layer(run.layer.mesh, context));
  run.filled.split_wall = *split.wall;
  run.envelope.envelope = std::move(split.envelope);
}

/// Collects the stage at which the run can stop.
void store_stage(Filling& filling, MeshRun& run) {
  FilledStage& filled = run.filled;
  LaidLayer& layer = run.layer;
  filled.slivers = run.layer_domain->domain.slivers;
  filled.envelope = std::move(run.envelope);
  filled.is_opened = layer.opened.has_value();
  if (layer.opened) {
    run.knowledge.closed = std::move(layer.mesh);
    run.knowledge.boundary = std::move(layer.boundary);
  }
  filled.layers = layer.opened ? std::move(*layer.opened) : std::move(layer.mesh);
  filled.curving_shares = layer.curving_shares;
  filled.tets = std::move(filling.tets);
  filled.tetra_failures = std::move(run.round.failures);
  filled.tetra_failures.insert(filled.tetra_failures.end(), filled.tets.failures.begin(), filled.tets.failures.end());
}

}  // namespace

void tetrahedra_step(MeshRun& run, const RunContext& context) {
  Filling filling = fill_around(*run.layer_domain, run.envelope.envelope, run.layer, run.makers, context);
  take_splits(filling, run, context);
  warn_of_layer(run, context);  // these are the warnings of a layer that is no longer the first one
  require_proved_cells(filling.proof->cells, run.layer.certificate);
  run.knowledge = {.report = std::move(run.layer.report), .certificate = std::move(run.layer.certificate), .check = std::move(filling.proof->check)};
  const MeshCase& options = run.layer_domain->options;
  if (!filling.split) run.knowledge.second = second_engine(options, std::move(filling.holes), filling.clear, run.layer_domain->domain.needs.traits);
  store_stage(filling, run);
  run.layer = {};
  run.layer_domain.reset();
  if (run.watch->filled) run.watch->filled(run.filled);
}

}  // namespace sterna::volmesh
