// Models whose surfaces or curves have no exact form in CAD files (deformed models, functions of scripts), approximated to a tolerance; for export only.
#pragma once

#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna::cad {

struct RefitReport {
  std::size_t n_surfaces = 0, n_curves = 0;  ///< number of distinct surfaces and curves that were replaced
  double error = 0.0;                        ///< metres: largest deviation found between a surface or curve and its replacement
};

/// Returns true if a surface, or the curve of an edge, has no form in OpenCASCADE.
bool needs_refit(const Model& model);

/// Returns a model of the same topology, names and parameters on splines within `tolerance`, metres; geometry shared by faces or edges stays shared. Tolerances
/// of edges and corners grow by the approximation error. Exact surfaces and curves are unchanged.
/// \throws Error(bad_argument) with the location where the tolerance is not reached
Model refitted(const Model& model, double tolerance, RefitReport& report, const RunContext& context);

}  // namespace sterna::cad
