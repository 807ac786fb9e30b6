// Stage 6 by our own methods (docs/method/optimisation.md, "Own objective"): feasible start, barrier on every macro-element, no step that leaves validity.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "volmesh/envelope/layer_objective.h"

namespace sterna::volmesh {

enum class OptimiseMethod {
  descent,  ///< block coordinate descent with local Newton models, colour by colour
  lbfgs,    ///< matrix-free L-BFGS over all unknowns at once
};

struct OptimiseSettings {
  OptimiseMethod method = OptimiseMethod::descent;
  int max_evaluations = 30;  ///< of the objective; a sweep of the descent counts as one
  /// Lengths of growth vectors, m, below which those that start longer do not go; empty: none.
  Column<VertexId, double> height_floor = {};
  double tolerance = 1e-3;  ///< the run ends when an iteration gains less than this share of what was gained so far
  ObjectiveWeights weights;
};

struct OptimiseReport {
  int n_evaluations = 0;
  std::size_t n_moving = 0;             ///< vertices that take part
  std::size_t n_taken_back = 0;         ///< vertices that went back to the start because the end was not accepted there
  std::vector<ObjectiveValue> history;  ///< start, then every accepted iterate; total falls monotonically
  std::string_view stopped;             ///< why
};

/// Upper heights for the optimisation: what stage 5 left where layers or gaps limit it, else the cap (docs/method/optimisation.md, "Bounds").
Column<VertexId, double> upper_heights(const LayerBase& base, const Envelope& envelope);

/// Of the start's smallest scaled Jacobian, what every element keeps (docs/method/optimisation.md, "Acceptance").
inline constexpr double k_quality_share = 0.9;
/// Smallest wedge_quality of the macro-elements that are prisms; 1 when there are none.
double smallest_scaled_jacobian(const LayerBase& base, const Envelope& envelope, const RunContext& context);
/// Takes vertices back to `start` until every macro-element is valid and has a scaled Jacobian of `least_quality`. Returns how many went back.
/// \pre `start` is so.
std::size_t take_back(const LayerBase& base, const Envelope& start, double least_quality, Envelope& envelope, const RunContext& context);

/// h_u: upper bound of the heights along the vertex normals, m; h_l: lower bound, m.
/// \pre every macro-element of `start` is valid.
/// \post every macro-element is valid (exact test and margins); no scaled Jacobian is below 0.9 of the smallest of the start. Collisions are not looked at:
/// apply_where_clear does.
Envelope optimise(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const OptimiseSettings& settings,
                  OptimiseReport& report, const RunContext& context);

}  // namespace sterna::volmesh
