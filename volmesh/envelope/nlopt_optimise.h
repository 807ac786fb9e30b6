// Stage 6 by NLopt: the paper's problem through LD_MMA, as published, or LD_CCSAQ (Svanberg 2002).
#pragma once

#include "volmesh/envelope/optimise.h"

namespace sterna::volmesh {

enum class NloptMethod { mma, ccsaq };

struct NloptSettings {
  NloptMethod method = NloptMethod::mma;
  int max_evaluations = 300;
  double max_seconds = k_automatic;   ///< wall clock; makes runs irreproducible, so it is off by default and reported when it struck
  double tolerance = 1e-6;            ///< relative change of the variables that ends the run
};

struct NloptReport {
  OptimiseReport run;                  ///< history: f_1 and f_2 of every evaluation
  std::size_t n_variables = 0;
  int n_shrunk = 0;                    ///< halvings of the heights that made the start feasible
  bool is_time_limit = false;          ///< the wall clock ended the run: the result is not reproducible
  ObjectiveValue best;                 ///< at the solver's best point, before elements went back
  std::int64_t n_invalid = 0;          ///< macro-elements that the exact test refuses there: (6) and (7) are necessary, not sufficient
};

/// Arguments and result as optimise(). \throws Error(cancelled) on a stop, Error(envelope_failed) when NLopt fails.
Envelope nlopt_optimise(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const NloptSettings& settings,
                        NloptReport& report, const RunContext& context);

}  // namespace sterna::volmesh
