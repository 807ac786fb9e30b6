// Stage 6 by block coordinate descent (docs/method/optimisation.md, "Own objective"). The start is feasible, every macro-element has a barrier, and no step
// leaves the valid region.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "volmesh/envelope/layer_objective.h"

namespace sterna::volmesh {

struct OptimiseSettings {
  int max_evaluations = 30;  ///< largest number of sweeps over all vertices, each followed by one evaluation of the objective
  /// Lower limits, m, for the lengths of growth vectors that are longer at the start; empty: no limits.
  Column<VertexId, double> height_floor = {};
  double tolerance = 1e-3;  ///< the run ends if an iteration gains less than this fraction of the total gain so far
  ObjectiveWeights weights;
};

struct OptimiseReport {
  int n_evaluations = 0;
  std::size_t n_moving = 0;             ///< number of vertices that can move
  std::size_t n_taken_back = 0;         ///< number of vertices moved back to the start because the result was not accepted there
  std::vector<ObjectiveValue> history;  ///< values at the start and after every accepted iteration; the total falls monotonically
  std::string_view stopped;             ///< name of the stopping criterion
};

/// Returns the upper heights. They are the heights of stage 5 where layers or gaps limit them, otherwise the cap (docs/method/optimisation.md, "Bounds").
Column<VertexId, double> upper_heights(const LayerBase& base, const Envelope& envelope);

/// Every element keeps at least this fraction of the smallest scaled Jacobian at the start (docs/method/optimisation.md, "Acceptance").
inline constexpr double k_quality_share = 0.9;
/// Returns the smallest wedge_quality of the macro-elements that are prisms; 1 if there are none.
double smallest_scaled_jacobian(const LayerBase& base, const Envelope& envelope, const RunContext& context);
/// Moves vertices back to `start` until every macro-element is valid and has a scaled Jacobian of at least `least_quality`. Returns the number of vertices
/// moved back.
/// \pre `start` meets both conditions
std::size_t take_back(const LayerBase& base, const Envelope& start, double least_quality, Envelope& envelope, const RunContext& context);

/// Optimises the envelope. \p h_u upper and \p h_l lower bound of the heights along the vertex normals, m
/// \pre every macro-element of `start` is valid
/// \post every macro-element is valid (exact test and margins); no scaled Jacobian is below 0.9 of the smallest of the start. Collisions are not tested:
/// apply_where_clear tests them.
Envelope optimise(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const OptimiseSettings& settings,
                  OptimiseReport& report, const RunContext& context);

}  // namespace sterna::volmesh
