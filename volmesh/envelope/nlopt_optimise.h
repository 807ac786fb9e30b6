// Stage 6 by NLopt: the paper's problem through LD_MMA, as published, or LD_CCSAQ (Svanberg 2002).
#pragma once

#include "volmesh/envelope/optimise.h"
#include "volmesh/envelope/paper_problem.h"

namespace sterna::volmesh {

enum class NloptMethod { mma, ccsaq };

struct NloptSettings {
  NloptMethod method = NloptMethod::mma;
  int max_evaluations = 300;         ///< evaluations of the objective; evaluations of the walk to feasibility are counted separately, with the same limit
  double max_seconds = k_automatic;  ///< wall clock; makes runs irreproducible, so it is off by default and reported if it was reached
  double tolerance = 1e-6;           ///< relative change of the variables (sums of absolute values) that ends the run
  double g1_min = 0.01;              ///< lower limit in (6); is_macro_valid requires the same value
  /// NLopt gets (5) as "sum of violated g <= this times the number of elements". With 0, value and gradient vanish inside the feasible set and there is
  /// nothing to approximate: the separable model rho sum dz^2 <= 0 admits no step, and NLopt stops at the start and reports convergence (measured; then the
  /// gain is 0). Elements that the slack makes invalid are repaired at the end. Among 1e-4 ... 1e-1 this value is best or nearly best on all of five
  /// aircraft.
  double slack = 1e-2;
};

struct NloptReport {
  struct Violation {
    int evaluation = 0;  ///< evaluation that gave the point at the same index in run.history; the first is of the starting point
    PaperConstraint constraint;
  };
  OptimiseReport run;                 ///< history: f_1 and f_2 at the start, then of every feasible point better than all before
  std::vector<Violation> violations;  ///< violations at the points of run.history
  std::size_t n_variables = 0;
  int n_feasibility_evaluations = 0;  ///< evaluations during the walk to feasibility; 0: the start was feasible
  int n_shrunk = 0;                   ///< additional height reductions during the walk
  bool is_feasible = true;            ///< false: the walk reached no feasible point, and the start is returned
  bool is_time_limit = false;         ///< the wall clock ended the run: the result is not reproducible
  ObjectiveValue best;                ///< at the solver's best point, before elements were taken back
  std::int64_t n_invalid = 0;         ///< macro-elements that fail the exact test at this point: (6) and (7) are necessary, not sufficient
};

/// Optimises with NLopt. Arguments and result as in optimise(); n_taken_back counts vertices that were taken part or all of the way back. An infeasible start
/// first walks to feasibility, and the feasible point found replaces the start (elements may be invalid there, and then stay invalid in the result).
/// \throws Error(cancelled) on a stop, Error(envelope_failed) when NLopt fails.
Envelope nlopt_optimise(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const NloptSettings& settings,
                        NloptReport& report, const RunContext& context);

}  // namespace sterna::volmesh
