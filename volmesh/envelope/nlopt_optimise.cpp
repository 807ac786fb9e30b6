#include "volmesh/envelope/nlopt_optimise.h"

#include <nlopt.h>

#include <exception>
#include <memory>
#include <new>

#include "geom/base/error.h"
#include "volmesh/envelope/paper_problem.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

constexpr double k_constraint_tolerance = 1e-9;  ///< of the sums (5), which are dimensionless
constexpr int k_max_shrinks = 30;                ///< halvings of the heights; less than 1e-9 of them is left then

/// What the C callbacks see. No exception may cross NLopt: the first one is kept and the run is stopped.
struct Run {
  PaperProblem& problem;
  const RunContext& context;
  NloptReport& report;
  nlopt_opt optimiser;
  std::exception_ptr trouble;

  template <class F>
  double guarded(const F& f) {
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

double objective_callback(unsigned, const double* z, double* gradient, void* data) {
  Run& run = *static_cast<Run*>(data);
  return run.guarded([&] {
    const ObjectiveValue value = run.problem.objective(z, gradient, run.context);
    run.report.run.history.push_back(value);
    ++run.report.run.n_evaluations;
    return value.total;
  });
}

double inversion_callback(unsigned, const double* z, double* gradient, void* data) {
  Run& run = *static_cast<Run*>(data);
  return run.guarded([&] { return run.problem.inversion(z, gradient, run.context).sum; });
}

double below_wall_callback(unsigned, const double* z, double* gradient, void* data) {
  Run& run = *static_cast<Run*>(data);
  return run.guarded([&] { return run.problem.below_wall(z, gradient, run.context).sum; });
}

void require_success(nlopt_result result, std::string_view what) {
  if (result >= 0) return;
  if (result == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
  throw Error({.code = ErrorCode::envelope_failed,
               .attempted = "optimising the envelope with NLopt",
               .problem = std::string(what) + ": " + (result == NLOPT_INVALID_ARGS ? "invalid arguments" : "failure") + " (NLopt code " + std::to_string(result) + ")",
               .hint = "use optimiser = \"descent\""});
}

/// Why the run ended; rounding limits are an end like any other.
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

/// Halves all heights and tangential ways until no constraint is violated; lines steepen no further by that.
void walk_to_feasibility(PaperProblem& problem, std::vector<double>& z, NloptReport& report, const RunContext& context) {
  const auto is_feasible = [&] { return problem.inversion(z.data(), nullptr, context).n_violated == 0 && problem.below_wall(z.data(), nullptr, context).n_violated == 0; };
  while (!is_feasible() && report.n_shrunk < k_max_shrinks) {
    ++report.n_shrunk;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = std::max(0.5 * z[i], problem.lower()[i]);
  }
}

}  // namespace

Envelope nlopt_optimise(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const NloptSettings& settings,
                        NloptReport& report, const RunContext& context) {
  report = {};
  PaperProblem problem(base, start, h_u, h_l, context);
  report.n_variables = problem.n_variables();
  report.run.n_moving = problem.n_moving();
  if (problem.n_variables() == 0) {
    report.run.stopped = "nothing moves";
    return start;
  }
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
      nlopt_create(settings.method == NloptMethod::mma ? NLOPT_LD_MMA : NLOPT_LD_CCSAQ, static_cast<unsigned>(problem.n_variables())), &nlopt_destroy);
  if (!optimiser) throw std::bad_alloc();
  Run run{problem, context, report, optimiser.get(), {}};
  std::vector<double> z = problem.variables(start);
  walk_to_feasibility(problem, z, report, context);
  report.run.history.push_back(problem.objective(z.data(), nullptr, context));
  require_success(nlopt_set_lower_bounds(optimiser.get(), problem.lower().data()), "lower bounds");
  require_success(nlopt_set_upper_bounds(optimiser.get(), problem.upper().data()), "upper bounds");
  require_success(nlopt_set_min_objective(optimiser.get(), objective_callback, &run), "objective");
  require_success(nlopt_add_inequality_constraint(optimiser.get(), inversion_callback, &run, k_constraint_tolerance), "constraint (6)");
  require_success(nlopt_add_inequality_constraint(optimiser.get(), below_wall_callback, &run, k_constraint_tolerance), "constraint (7)");
  require_success(nlopt_set_xtol_rel(optimiser.get(), settings.tolerance), "tolerance");
  require_success(nlopt_set_maxeval(optimiser.get(), settings.max_evaluations), "evaluations");
  if (!is_automatic(settings.max_seconds)) require_success(nlopt_set_maxtime(optimiser.get(), settings.max_seconds), "time limit");
  double f = 0.0;
  const nlopt_result result = nlopt_optimize(optimiser.get(), z.data(), &f);
  if (run.trouble) std::rethrow_exception(run.trouble);
  if (result != NLOPT_ROUNDOFF_LIMITED) require_success(result, "optimisation");
  report.run.stopped = reason_of(result);
  report.is_time_limit = result == NLOPT_MAXTIME_REACHED;
  report.best = problem.objective(z.data(), nullptr, context);

  Envelope optimised = start;
  problem.store(z.data(), optimised);
  report.n_invalid = static_cast<std::int64_t>(invalid_macros(base, optimised, context).size());
  report.run.n_taken_back = take_back(base, start, k_quality_share * smallest_scaled_jacobian(base, start, context), optimised, context);
  const ObjectiveValue before = problem.objective(problem.variables(start).data(), nullptr, context);
  const ObjectiveValue after = problem.objective(problem.variables(optimised).data(), nullptr, context);
  return after.total < before.total ? optimised : start;
}

}  // namespace sterna::volmesh
