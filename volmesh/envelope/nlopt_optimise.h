// Stage 6 by NLopt: solves the paper's problem with LD_MMA, as published, or with LD_CCSAQ (Svanberg 2002).
#pragma once

#include "volmesh/envelope/optimise.h"
#include "volmesh/envelope/paper_problem.h"

namespace sterna::volmesh {

enum class NloptMethod { mma, ccsaq };

struct NloptSettings {
  NloptMethod method = NloptMethod::mma;
  /// Largest number of evaluations of the objective; evaluations during the walk to a feasible point are counted separately, with the same limit.
  int max_evaluations = 300;
  /// Limit for the elapsed time. Results are then not reproducible, so it is off by default, and the report states if it was reached.
  double max_seconds = k_automatic;
  double tolerance = 1e-6;  ///< relative change of the variables (sum of absolute values) at which the run ends
  double g1_min = 0.01;     ///< lower limit in eq. (6); is_macro_valid requires the same value
  /// NLopt gets (5) in the form "sum of violated g <= slack times the number of elements". With a slack of 0, value and gradient vanish inside the feasible
  /// set, and NLopt has nothing to approximate: the separable model rho sum dz^2 <= 0 admits no step. NLopt then stops at the start and reports convergence
  /// (measured: the gain is 0). Elements that the slack makes invalid are repaired at the end. Of the values from 1e-4 to 1e-1 this one is best or nearly best
  /// for all of five aircraft.
  double slack = 1e-2;
};

struct NloptReport {
  struct Violation {
    int evaluation = 0;  ///< number of the evaluation of the point at the same index in run.history; the first one is the start
    PaperConstraint constraint;
  };
  OptimiseReport run;                 ///< history: f_1 and f_2 at the start, then of every feasible point that is better than all before
  std::vector<Violation> violations;  ///< violations at the points of run.history
  std::size_t n_variables = 0;
  int n_feasibility_evaluations = 0;  ///< number of evaluations during the walk to a feasible point; 0: the start was feasible
  int n_shrunk = 0;                   ///< number of additional height reductions during the walk
  bool is_feasible = true;            ///< false: the walk reached no feasible point, and the start is returned
  bool is_time_limit = false;         ///< the wall clock ended the run: the result is not reproducible
  ObjectiveValue best;                ///< values at the solver's best point, before elements were taken back
  std::int64_t n_invalid = 0;         ///< number of macro-elements that fail the exact test at this point, because (6) and (7) are necessary but not sufficient
};

/// Optimises with NLopt. Arguments and result are those of optimise(); n_taken_back counts vertices that were moved back part or all of the way. From an
/// infeasible start, the optimiser first walks to a feasible point, which replaces the start. (Elements may be invalid there, and then stay invalid in the
/// result.)
/// \throws Error(cancelled) after a stop; Error(envelope_failed) if NLopt fails
Envelope nlopt_optimise(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const NloptSettings& settings,
                        NloptReport& report, const RunContext& context);

}  // namespace sterna::volmesh
