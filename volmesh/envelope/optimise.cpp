#include "volmesh/envelope/optimise.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

constexpr double k_rest = 2e-3;  ///< in units of h_u: after a smaller move, a vertex is not visited again until a neighbour moves by more than this

bool is_converged(const std::vector<ObjectiveValue>& history, double tolerance) {
  if (history.size() < 3) return false;
  const double now = history.back().total;
  return history[history.size() - 2].total - now < tolerance * (history.front().total - now);
}

void run_descent(LayerObjective& objective, const OptimiseSettings& settings, Vec3Field& y, OptimiseReport& report, const RunContext& context) {
  std::vector<std::uint8_t> active(objective.size());
  for (std::size_t i = 0; i < active.size(); ++i) active[i] = objective.is_moving(i);
  report.history.push_back(objective.evaluate(y, context));
  report.stopped = "evaluations";
  while (report.n_evaluations < settings.max_evaluations) {
    const std::size_t n_visits = objective.descend(y, active, k_rest, context);
    report.history.push_back(objective.evaluate(y, context));
    ++report.n_evaluations;
    context.progress(static_cast<double>(report.n_evaluations) / settings.max_evaluations);
    if (n_visits == 0 || is_converged(report.history, settings.tolerance)) {
      report.stopped = "converged";
      return;
    }
  }
}

}  // namespace

std::size_t take_back(const LayerBase& base, const Envelope& start, double limit, Envelope& envelope, const RunContext& context) {
  const std::size_t n = base.wall.n_vertices();
  std::size_t n_back = 0;
  Column<VertexId, std::uint8_t> dirty(n, 1);
  while (true) {
    const std::vector<TriangleId> bad = low_quality_elements(base, envelope, limit, dirty, context);
    dirty.assign(n, 0);
    bool has_changed = false;
    for (const TriangleId t : bad) {
      for (const VertexId v : base.wall.triangles[t]) {
        if (envelope.height[v] == start.height[v] && envelope.direction[v] == start.direction[v]) continue;
        envelope.height[v] = start.height[v];
        envelope.direction[v] = start.direction[v];
        dirty[v] = 1;
        has_changed = true;
        ++n_back;
      }
    }
    if (!has_changed) return n_back;
  }
}

double smallest_scaled_jacobian(const LayerBase& base, const Envelope& envelope, const RunContext& context) {
  return parallel_reduce(
      context, base.wall.n_triangles(), 1.0,
      [&](std::size_t begin, std::size_t end) {
        double least = 1.0;
        for (std::size_t i = begin; i < end; ++i) {
          const MacroElement e = macro_element(base, envelope, TriangleId(i));
          if (is_prism(e) && !base.is_virtual(TriangleId(i))) least = std::min(least, scaled_jacobian(e));
        }
        return least;
      },
      [](double a, double b) { return std::min(a, b); });
}

Column<VertexId, double> upper_heights(const LayerBase& base, const Envelope& envelope) {
  Column<VertexId, double> h_u = envelope.height;
  for (const VertexId v : h_u.ids()) {
    if (envelope.is_collapsed(v)) continue;
    const bool is_kept_apart = envelope.limit[v] == HeightLimit::gap || envelope.limit[v] == HeightLimit::collision;
    h_u[v] = is_kept_apart ? envelope.height[v] * dot(envelope.direction[v], base.vertex_normal[v])
                           : std::max(envelope.height[v], std::min(envelope.target[v], envelope.cap[v]));
  }
  return h_u;
}

Envelope optimise(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const OptimiseSettings& settings,
                  OptimiseReport& report, const RunContext& context) {
  const double least_quality = k_quality_share * smallest_scaled_jacobian(base, start, context);
  LayerObjective objective(base, start, h_u, h_l, least_quality, settings.weights, context, settings.height_floor);
  report = {};
  report.n_moving = objective.n_moving();
  Vec3Field y = objective.unknowns(start);
  run_descent(objective, settings, y, report, context);
  Envelope result = start;
  objective.store(y, result);
  report.n_taken_back = take_back(base, start, least_quality, result, context);
  return result;
}

}  // namespace sterna::volmesh
