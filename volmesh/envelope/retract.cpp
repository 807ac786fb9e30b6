#include "volmesh/envelope/retract.h"

#include <algorithm>

#include "geom/base/parallel.h"
#include "geom/base/sort_unique.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

constexpr double k_pair_reserve = 0.98;      ///< factor on the largest fraction of the heights at which a pair of triangles is clear
constexpr double k_clearance_factor = 0.95;  ///< factor that is applied once after the last collision; it leaves a gap for tetrahedra between retracted layers
constexpr int k_clear_regrow_rounds = 6;
constexpr std::uint8_t k_not_tried = 255;  ///< number of failures after which no more steps are made
constexpr std::uint8_t k_first_step = 1;   ///< the first step of regrowth is not the largest one, because that rarely keeps the clearance

/// Lowers heights on both sides of crossing pairs to the largest fraction at which the pair is clear, or collapses the vertices. Returns the vertices of the
/// pairs.
std::vector<VertexId> lower_pairs(const Collider& collider, const std::vector<BoundaryCrossing>& pairs, bool must_collapse, const EnvelopeScale& scale,
                                  Envelope& envelope, const RunContext& context) {
  std::vector<double> share(pairs.size(), 0.0);
  if (!must_collapse)
    parallel_for(
        context, pairs.size(), [&](std::size_t i) { share[i] = k_pair_reserve * collider.clear_share(pairs[i], envelope); }, 16);
  // A vertex of several pairs gets the lowest height. All heights are computed from those before this round.
  std::vector<std::pair<VertexId, double>> target;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const BoundaryTriangle& triangle : pairs[i]) {
      const double height = share[i] * collider.tallest(triangle, envelope);
      for (const VertexId v : collider.moving_vertices(triangle)) target.emplace_back(v, height);
    }
  }
  std::sort(target.begin(), target.end());
  std::vector<VertexId> vertices;
  for (const auto& [v, height] : target) {
    if (!vertices.empty() && vertices.back() == v) continue;
    vertices.push_back(v);
    lower(envelope, v, height, HeightLimit::collision, scale);
  }
  return vertices;
}

/// Takes a trial change back at vertices where the top crosses another part of the boundary. The changed heights are multiplied by `stretch` for this test.
void take_back_crossing(TrialChange& trial, Collider& collider, const EnvelopeShape& shape, double stretch, const RunContext& context) {
  std::vector<VertexId> around = trial.vertices_in_force();
  for (bool is_first = true; !around.empty(); is_first = false) {
    collider.move_top(shape, context, stretch, &trial.in_force());
    std::vector<VertexId> gone;
    // Vertices that were taken back were clear of everything that has not moved, so only pairs with moved vertices are tested.
    for (const BoundaryCrossing& pair : collider.crossings(context, &around, is_first ? nullptr : &trial.in_force()))
      for (const BoundaryTriangle& triangle : pair)
        for (const VertexId v : collider.moving_vertices(triangle))
          if (trial.take_back(v)) gone.push_back(v);
    // Taking a vertex back may make an adjacent element invalid. The vertices of such elements are then taken back, too.
    const std::vector<VertexId> more = trial.take_back_invalid(gone);
    gone.insert(gone.end(), more.begin(), more.end());
    around = std::move(gone);
  }
}

}  // namespace

std::vector<VertexId> apply_where_clear(const LayerBase& base, Collider& collider, EnvelopeShape& envelope, ShapeChange change, const RunContext& context,
                                        double clearance) {
  if (change.vertices.empty()) return {};
  std::vector<VertexId> vertices = change.vertices;
  TrialChange trial(base, envelope, std::move(change), context);
  trial.take_back_invalid(std::move(vertices));
  if (clearance != 1.0) take_back_crossing(trial, collider, envelope, clearance, context);
  take_back_crossing(trial, collider, envelope, 1.0, context);
  return trial.vertices_in_force();
}

std::vector<VertexId> apply_where_clear(const LayerBase& base, Collider& collider, EnvelopeShape& envelope, const EnvelopeShape& proposal,
                                        const RunContext& context, double clearance) {
  return apply_where_clear(base, collider, envelope, difference(envelope, proposal, context), context, clearance);
}

void regrow_clear(const LayerBase& base, Collider& collider, Envelope& envelope, const RunContext& context, const std::vector<VertexId>* where) {
  Column<VertexId, std::uint8_t> n_failures(envelope.height.size(), where ? k_not_tried : k_first_step);
  if (where)
    for (const VertexId v : *where) n_failures[v] = k_first_step;
  for (int round = 0; round < k_clear_regrow_rounds; ++round) {
    ShapeChange change = raised(base, envelope, n_failures, context);
    if (change.vertices.empty()) return;
    const std::vector<VertexId> tried = change.vertices;
    count_failures(tried, apply_where_clear(base, collider, envelope, std::move(change), context), n_failures);
  }
}

bool retract_collisions(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context,
                        const std::vector<VertexId>* suspects) {
  const EnvelopeScale scale = scale_of(base, options);
  std::vector<VertexId> around, retracted;
  const std::vector<VertexId>* looked_at = suspects;
  bool needs_clearance = false, has_changed = false;
  for (int sweep = 0;; ++sweep) {
    collider.move_top(envelope, context);
    const std::vector<BoundaryCrossing> pairs = collider.crossings(context, looked_at);
    context.progress(static_cast<double>(sweep) / (sweep + 5.0));
    const std::vector<Swallowing> swallowings = pairs.empty() ? collider.swallowings(envelope) : std::vector<Swallowing>{};
    if (pairs.empty() && swallowings.empty()) {
      if (!needs_clearance) return has_changed;
      // All retracted heights are reduced once more. This may cause new collisions, so the tests are repeated once.
      needs_clearance = false;
      sort_unique(retracted);
      for (const VertexId v : retracted) lower(envelope, v, k_clearance_factor * envelope.height[v], HeightLimit::collision, scale);
      around = retracted;
    } else {
      // From sweep max_retract_sweeps on, each sweep collapses a vertex, so the loop terminates.
      context.debug("layers collide at " + std::to_string(pairs.size() + swallowings.size()) + " locations");
      const bool must_collapse = sweep >= options.max_retract_sweeps;
      around = lower_pairs(collider, pairs, must_collapse, scale, envelope, context);
      for (const Swallowing& found : swallowings) {
        const double share = must_collapse ? 0.0 : k_pair_reserve * found.clear_share;
        for (const VertexId v : found.vertices) lower(envelope, v, share * envelope.height[v], HeightLimit::collision, scale);
        around.insert(around.end(), found.vertices.begin(), found.vertices.end());
      }
      retracted.insert(retracted.end(), around.begin(), around.end());
      needs_clearance = !must_collapse;
    }
    has_changed = true;
    const std::vector<VertexId> lowered = unwarp(base, options, HeightLimit::warp, envelope, context, &around);
    around.insert(around.end(), lowered.begin(), lowered.end());
    sort_unique(around);
    looked_at = &around;
  }
}

}  // namespace sterna::volmesh
