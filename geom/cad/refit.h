// Models whose surfaces or curves have no exact form in CAD files (deformed, functions of scripts) made exact to a tolerance: for export alone.
#pragma once

#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna::cad {

struct RefitReport {
  std::size_t n_surfaces = 0, n_curves = 0;  ///< distinct ones that were replaced
  double error = 0.0;                        ///< metres: largest found between a surface or curve and what replaced it
};

/// True where a surface, or an edge's curve, has no form in OpenCASCADE.
bool needs_refit(const Model& model);

/// The same topology, names and parameters on splines within `tolerance`, metres; what faces or edges share stays shared. Tolerances of edges and corners grow
/// by what was lost. Exact surfaces and curves stay as they are.
/// \throws Error(bad_argument) with the place where the tolerance is not reached
Model refitted(const Model& model, double tolerance, RefitReport& report, const RunContext& context);

}  // namespace sterna::cad
