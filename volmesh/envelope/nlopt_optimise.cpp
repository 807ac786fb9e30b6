// Steps: if the start is not feasible, walk to a feasible point; minimise under the constraint; take back invalid elements. Exceptions of the callbacks are
// stored, and thrown after the return from the C library. Based on: S. G. Johnson, The NLopt nonlinear-optimization package; K. Svanberg, A class of globally
// convergent optimization methods based on conservative convex separable approximations, SIAM J. Optim. 12 (2002).
#include "volmesh/envelope/nlopt_optimise.h"

#include <nlopt.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <new>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

constexpr double k_walk_end = 1e-6;       ///< the walk to a feasible point ends at this sum of violated g, dimensionless; for comparison, g_1,min is 1e-2
constexpr int k_max_return_halvings = 8;  ///< number of halvings of a vertex's displacement, after which the vertex is moved back to its start
constexpr double k_shrink = 0.9;          ///< factor on a growth edge in each step of the second part of the walk

/// Data of the C callbacks. NLopt gets the sums of (8) and (9) times n_v instead of the means; the minimum is the same. The reason is NLopt's estimate of the
/// curvature, rho, which starts at 1 and never falls below 1e-5. For a mean over a million vertices the curvature is 1e-6, and such a lower limit would keep
/// the steps far too short.
struct Run {
  const PaperProblem& problem;
  const NloptSettings& settings;
  NloptReport& report;
  const RunContext& context;
  bool is_walking = false;  ///< the run minimises only the sum of violated g
  nlopt_opt optimiser = nullptr;
  int n_evaluations = 0;
  PaperObjective last;  ///< values at the point of the latest evaluation; NLopt evaluates the constraint at a point after the objective
  double best_value = std::numeric_limits<double>::infinity();
  std::vector<double> best{};  ///< best feasible point; during the walk, the least infeasible point
  std::exception_ptr trouble{};

  double slack() const { return settings.slack * static_cast<double>(problem.n_elements()); }

  void keep(double value, std::span<const double> z) {
    best_value = value;
    best.assign(z.begin(), z.end());
  }

  double objective(std::span<const double> z, std::span<double> gradient) {
    ++n_evaluations;
    context.progress(std::min(1.0, static_cast<double>(n_evaluations) / settings.max_evaluations));
    if (is_walking) {
      const double g = problem.constraint(z, gradient, context).total();
      if (g < best_value) keep(g, z);
      return g;
    }
    last = problem.objective(z, gradient, context);
    const double scale = static_cast<double>(problem.n_vertices());
    for (double& d : gradient) d *= scale;
    return scale * last.total();
  }

  double constraint(std::span<const double> z, std::span<double> gradient) {
    const PaperConstraint g = problem.constraint(z, gradient, context);
    if (g.total() <= slack() && last.total() < best_value) {
      keep(last.total(), z);
      report.run.history.push_back({.f1 = last.f1, .f2 = last.f2, .total = last.total()});
      report.violations.push_back({n_evaluations, g});
    }
    return g.total() - slack();
  }

  /// Runs f such that no exception passes through NLopt. The first exception is stored, and the run is stopped.
  template <class F>
  double guarded(const F& f) noexcept {
    try {
      if (trouble) return 0.0;
      context.check_stop();
      return f();
    } catch (...) {
      trouble = std::current_exception();
      nlopt_force_stop(optimiser);
      return 0.0;
    }
  }
};

std::span<double> gradient_of(double* gradient, unsigned n) { return gradient ? std::span<double>(gradient, n) : std::span<double>(); }

double objective_callback(unsigned n, const double* z, double* gradient, void* data) {
  Run& run = *static_cast<Run*>(data);
  return run.guarded([&] { return run.objective({z, n}, gradient_of(gradient, n)); });
}

double constraint_callback(unsigned n, const double* z, double* gradient, void* data) {
  Run& run = *static_cast<Run*>(data);
  return run.guarded([&] { return run.constraint({z, n}, gradient_of(gradient, n)); });
}

void require_success(nlopt_result result, std::string_view what) {
  if (result >= 0) return;
  if (result == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
  throw Error(
      {.code = ErrorCode::envelope_failed,
       .attempted = "optimising the envelope with NLopt",
       .problem = std::string(what) + ": " + (result == NLOPT_INVALID_ARGS ? "invalid arguments" : "failure") + " (NLopt code " + std::to_string(result) + ")",
       .hint = "use optimiser = \"descent\""});
}

/// Returns the name of the stopping criterion. Limits because of rounding count as a regular end.
std::string_view reason_of(nlopt_result result) {
  switch (result) {
    case NLOPT_XTOL_REACHED: return "converged";
    case NLOPT_FTOL_REACHED: return "converged in f";
    case NLOPT_STOPVAL_REACHED: return "stop value";
    case NLOPT_MAXEVAL_REACHED: return "evaluations";
    case NLOPT_MAXTIME_REACHED: return "time limit";
    case NLOPT_ROUNDOFF_LIMITED: return "rounding";
    default: return "finished";
  }
}

/// Runs NLopt once from z. \post run.best is the best point evaluated, if there was any
nlopt_result minimise(Run& run, std::vector<double> z) {
  const NloptSettings& settings = run.settings;
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
      nlopt_create(settings.method == NloptMethod::mma ? NLOPT_LD_MMA : NLOPT_LD_CCSAQ, static_cast<unsigned>(z.size())), &nlopt_destroy);
  if (!optimiser) throw std::bad_alloc();
  run.optimiser = optimiser.get();
  require_success(nlopt_set_lower_bounds(optimiser.get(), run.problem.bounds().lower.data()), "lower bounds");
  require_success(nlopt_set_upper_bounds(optimiser.get(), run.problem.bounds().upper.data()), "upper bounds");
  require_success(nlopt_set_min_objective(optimiser.get(), objective_callback, &run), "objective");
  if (run.is_walking) require_success(nlopt_set_stopval(optimiser.get(), k_walk_end), "stop value");
  else require_success(nlopt_add_inequality_constraint(optimiser.get(), constraint_callback, &run, 0.0), "constraint (5)");
  require_success(nlopt_set_xtol_rel(optimiser.get(), settings.tolerance), "tolerance");
  require_success(nlopt_set_maxeval(optimiser.get(), settings.max_evaluations), "evaluations");
  if (!is_automatic(settings.max_seconds)) require_success(nlopt_set_maxtime(optimiser.get(), settings.max_seconds), "time limit");
  double value = 0.0;
  const nlopt_result result = nlopt_optimize(optimiser.get(), z.data(), &value);
  if (run.trouble) std::rethrow_exception(run.trouble);
  if (result != NLOPT_ROUNDOFF_LIMITED) require_success(result, "optimisation");
  return result;
}

/// Minimises only the sum of violated g. If this ends in a local minimum, shortens the growth edges of elements that are still violated. Returns true if the
/// result is feasible.
bool walk_to_feasibility(const PaperProblem& problem, const NloptSettings& settings, std::vector<double>& z, NloptReport& report, const RunContext& context) {
  Run run{.problem = problem, .settings = settings, .report = report, .context = context, .is_walking = true};
  minimise(run, z);
  report.n_feasibility_evaluations = run.n_evaluations;
  z = std::move(run.best);
  while (problem.constraint(z, {}, context).total() > k_walk_end && problem.shrink_violated(z, k_shrink, context) > 0) ++report.n_shrunk;
  return problem.constraint(z, {}, context).total() <= run.slack();
}

/// Moves vertices of elements that are invalid or worse than `least_quality` half the way back to `from`. Repeats this, and finally moves them back completely,
/// until there are no such elements (except those that are invalid or worse in `from` as well). `optimised` is at z at first. Returns the number of vertices
/// that were moved back.
std::size_t go_back(const LayerBase& base, const PaperProblem& problem, const Envelope& from, double least_quality, std::vector<double> z, Envelope& optimised,
                    const RunContext& context) {
  const std::size_t n = base.wall.n_vertices();
  const std::vector<double> z_from = problem.unknowns(from);
  Column<VertexId, std::uint8_t> dirty(n, 1), n_halvings(n, 0);
  std::size_t n_back = 0;
  while (true) {
    const std::vector<TriangleId> bad = low_quality_elements(base, optimised, least_quality, dirty, context);
    dirty.assign(n, 0);
    bool has_moved = false;
    for (const TriangleId t : bad) {
      for (const VertexId v : base.wall.triangles[t]) {
        const std::span<double> own = problem.unknowns_of(v, z);
        if (dirty[v] || own.empty() || n_halvings[v] > k_max_return_halvings) continue;
        dirty[v] = 1;
        has_moved = true;
        n_back += n_halvings[v] == 0;
        const double share = ++n_halvings[v] > k_max_return_halvings ? 0.0 : 0.5;
        const double* const origin = z_from.data() + (own.data() - z.data());
        for (std::size_t k = 0; k < own.size(); ++k) own[k] = origin[k] + share * (own[k] - origin[k]);
      }
    }
    if (!has_moved) return n_back;
    problem.store(z, optimised, context);
    parallel_for(context, n, [&](std::size_t i) {
      const VertexId v(i);
      if (n_halvings[v] <= k_max_return_halvings) return;
      optimised.height[v] = from.height[v];  // bit-exact
      optimised.direction[v] = from.direction[v];
    });
  }
}

}  // namespace

Envelope nlopt_optimise(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const NloptSettings& settings,
                        NloptReport& report, const RunContext& context) {
  const PaperProblem problem(base, start, h_u, h_l, settings.g1_min, context);
  report = {};
  report.n_variables = problem.n_unknowns();
  report.run.n_moving = problem.n_vertices();
  if (problem.n_unknowns() == 0) {
    report.run.stopped = "no vertex can move";
    return start;
  }
  std::vector<double> z = problem.unknowns(start);
  // The points are outside of the bounds by rounding errors only.
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = std::clamp(z[i], problem.bounds().lower[i], problem.bounds().upper[i]);
  Envelope from = start;
  if (problem.constraint(z, {}, context).total() > k_walk_end) {
    report.is_feasible = walk_to_feasibility(problem, settings, z, report, context);
    if (!report.is_feasible) {
      report.run.stopped = "no feasible point found";
      return start;
    }
    problem.store(z, from, context);
  }
  const PaperObjective before = problem.objective(z, {}, context);

  Run run{.problem = problem, .settings = settings, .report = report, .context = context};
  const nlopt_result result = minimise(run, std::move(z));
  report.run.n_evaluations = run.n_evaluations;
  report.run.stopped = reason_of(result);
  report.is_time_limit = result == NLOPT_MAXTIME_REACHED;
  if (report.run.history.empty()) {  // the start itself violates the constraint by more than the slack
    report.is_feasible = false;
    report.run.stopped = "no feasible point found";
    return start;
  }
  report.best = report.run.history.back();

  Envelope optimised = from;
  problem.store(run.best, optimised, context);
  report.n_invalid = static_cast<std::int64_t>(invalid_macros(base, optimised, context).size());
  const double least_quality = smallest_scaled_jacobian(base, from, context);
  report.run.n_taken_back = go_back(base, problem, from, std::min(k_quality_share * least_quality, least_quality), std::move(run.best), optimised, context);
  const PaperObjective after = problem.objective(problem.unknowns(optimised), {}, context);
  return after.total() < before.total() ? optimised : from;
}

}  // namespace sterna::volmesh
