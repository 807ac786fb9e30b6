// Stage 6 by NLopt: the paper's problem through LD_MMA, as published, or LD_CCSAQ (Svanberg 2002).
#pragma once

#include "volmesh/envelope/optimise.h"
#include "volmesh/envelope/paper_problem.h"

namespace sterna::volmesh {

enum class NloptMethod { mma, ccsaq };

struct NloptSettings {
  NloptMethod method = NloptMethod::mma;
  int max_evaluations = 300;         ///< of the objective; those of the walk to feasibility count apart, with the same limit
  double max_seconds = k_automatic;  ///< wall clock; makes runs irreproducible, so it is off by default and reported when it struck
  double tolerance = 1e-6;           ///< relative change of the variables (sums of absolute values) that ends the run
  double g1_min = 0.01;              ///< of (6); is_macro_valid asks for as much
  /// NLopt gets (5) as "sum of violated g <= this times the number of elements". With 0 there is nothing to approximate inside the feasible set: value and
  /// gradient vanish there, the separable model rho sum dz^2 <= 0 admits no step, and NLopt stops where it started and calls it converged (measured; then
  /// the gain is 0). Elements that the slack spoils are mended at the end. Of 1e-4 ... 1e-1 on five aircraft this is best or nearly so on all.
  double slack = 1e-2;
};

struct NloptReport {
  struct Violation {
    int evaluation = 0;  ///< that gave the point of the same place in run.history; the first is of the point where the run starts
    PaperConstraint constraint;
  };
  OptimiseReport run;                 ///< history: f_1 and f_2 where the run starts, then of every feasible point better than all before it
  std::vector<Violation> violations;  ///< of the points of run.history
  std::size_t n_variables = 0;
  int n_feasibility_evaluations = 0;  ///< of the walk to feasibility; 0: the start was feasible
  int n_shrunk = 0;                   ///< steps of the heights that the walk needed besides
  bool is_feasible = true;            ///< false: the walk did not arrive, and the start is returned
  bool is_time_limit = false;         ///< the wall clock ended the run: the result is not reproducible
  ObjectiveValue best;                ///< at the solver's best point, before elements went back
  std::int64_t n_invalid = 0;         ///< macro-elements that the exact test refuses there: (6) and (7) are necessary, not sufficient
};

/// Arguments and result as optimise(); n_taken_back counts vertices that went part or all of the way back. An infeasible start first walks to feasibility, and
/// the point where it arrives takes the place of the start (elements may be invalid there, and then are so in the result).
/// \throws Error(cancelled) on a stop, Error(envelope_failed) when NLopt fails.
Envelope nlopt_optimise(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const NloptSettings& settings,
                        NloptReport& report, const RunContext& context);

}  // namespace sterna::volmesh
