#include "volmesh/envelope/global_optimisation.h"

#include <algorithm>
#include <cstdio>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "volmesh/envelope/nlopt_optimise.h"
#include "volmesh/envelope/optimise.h"
#include "volmesh/envelope/retract.h"

namespace sterna::volmesh {
namespace {

/// Fractions of the displacement to the optimum. They are tried one after the other.
constexpr std::array<double, 4> k_step_shares = {1.0, 0.5, 0.25, 0.125};

/// Fraction of the target, slightly above the fraction that counts as full height (layer_report.cpp).
constexpr double k_full_height = 0.91;
/// Fraction of the target below which the optimisation does not lower a height. Smoothness justifies a small loss of height, but not a hole in the layer.
constexpr double k_least_optimised_height = 0.8;

void log_result(const OptimiseReport& report, std::string_view optimiser, const RunContext& context) {
  if (report.history.empty()) {  // no vertex may move, or no point that was tried was feasible
    context.info("optimised (" + std::string(optimiser) + "): the envelope is unchanged, " + std::string(report.stopped));
    return;
  }
  const ObjectiveValue &a = report.history.front(), &b = report.history.back();
  char text[256];
  std::snprintf(text, sizeof text, "optimised (%.*s): orthogonality %.4g -> %.4g, height %.4g -> %.4g, top %.4g -> %.4g; %d evaluations, %.*s",
                static_cast<int>(optimiser.size()), optimiser.data(), a.f1, b.f1, a.f2, b.f2, a.f3, b.f3, report.n_evaluations,
                static_cast<int>(report.stopped.size()), report.stopped.data());
  context.debug(text);
}

Envelope optimum(const LayerBase& base, const EnvelopeOptions& options, const Envelope& start, const RunContext& context) {
  const Column<VertexId, double> h_u = upper_heights(base, start);
  const double h_l = scale_of(base, options).least_height();
  if (options.optimiser == "descent") {
    OptimiseSettings settings;
    settings.max_evaluations = options.optimiser_evaluations;
    settings.weights = {.height = options.height_weight, .top = options.top_weight, .membrane = options.membrane_weight, .barrier = options.barrier_weight};
    settings.height_floor = start.target;
    for (double& h : settings.height_floor) h *= k_least_optimised_height;
    OptimiseReport report;
    Envelope result = optimise(base, start, h_u, h_l, settings, report, context);
    log_result(report, options.optimiser, context);
    return result;
  }
  if (options.optimiser != "mma" && options.optimiser != "ccsaq")
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "optimising the envelope",
                 .problem = "unknown optimiser \"" + options.optimiser + "\"",
                 .hint = "use one of none, descent, mma, ccsaq"});
  NloptSettings settings;
  settings.method = options.optimiser == "mma" ? NloptMethod::mma : NloptMethod::ccsaq;
  settings.max_evaluations = options.optimiser_evaluations;
  NloptReport report;
  Envelope result = nlopt_optimise(base, start, h_u, h_l, settings, report, context);
  log_result(report.run, options.optimiser, context);
  return result;
}

}  // namespace

void optimise_globally(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  if (options.optimiser == "none") return;
  const Envelope start = envelope;
  const Envelope best = optimum(base, options, start, context);
  const auto is_at = [](const Envelope& a, const Envelope& b, VertexId v) { return a.height[v] == b.height[v] && a.direction[v] == b.direction[v]; };
  for (const double share : k_step_shares) {
    EnvelopeShape proposal = envelope;
    parallel_for(context, base.wall.n_vertices(), [&](std::size_t i) {
      const VertexId v(i);
      if (is_at(best, start, v) || !is_at(envelope, start, v)) return;  // the vertex is already at the optimum, or moved by a larger fraction before
      if (share == 1.0) {
        proposal.height[v] = best.height[v];
        proposal.direction[v] = best.direction[v];
        return;
      }
      const Vec3 g = (1.0 - share) * start.height[v] * start.direction[v] + share * best.height[v] * best.direction[v];
      // Not the length of g, because the chord between two directions is shorter.
      proposal.height[v] = (1.0 - share) * start.height[v] + share * best.height[v];
      proposal.direction[v] = normalized(g);
    });
    apply_where_clear(base, collider, envelope, proposal, context);
  }
  // If no other limit applies to a vertex, the shape of the envelope limits it, because the optimiser was free to raise it.
  parallel_for(context, base.wall.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    if (envelope.limit[v] == HeightLimit::none && envelope.height[v] < k_full_height * envelope.target[v]) envelope.limit[v] = HeightLimit::warp;
  });
}

}  // namespace sterna::volmesh
