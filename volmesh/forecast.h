// Forecast of the size and cost of a mesh before it is made; a mesh that exceeds the machine's memory is an error at once.
#pragma once

#include <cstddef>

#include "geom/base/run_context.h"
#include "volmesh/case/limit_options.h"
#include "volmesh/site/site.h"
#include "volmesh/tetra/size_field.h"

namespace sterna::volmesh {

/// Forecast for the machine that docs/measurements/performance.md was measured on; memory is accurate to a quarter there, time to a factor of two.
struct Forecast {
  double n_triangles = 0.0;   ///< triangles of the walls with layers
  double n_prisms = 0.0;      ///< cells of the layer
  double n_tetrahedra = 0.0;  ///< estimate from sizes and boundary
  double bytes() const;       ///< peak memory of the whole process
  double seconds(int threads) const;
};

/// Returns the forecast before the envelope: cells of the requested layer, and the least number of tetrahedra for walls with so many triangles.
/// \pre options of the site validated
Forecast forecast_of(const MeshingSite& site);
/// Returns the number of tetrahedra that a size field requires, from its leaves; tetrahedra at the boundary are included.
double expected_tetrahedra(const SizeField& sizes);

/// Checks the forecast against the limits, and logs a long run.
/// \throws Error(overflow) with the figures and the remedy if the forecast exceeds the allowed value; with `force` a warning
void require_room(const Forecast& forecast, const LimitOptions& limits, const RunContext& context);

}  // namespace sterna::volmesh
