// Forecast of the size and cost of a mesh before it is made. A mesh that exceeds the memory of the machine is rejected before the work.
#pragma once

#include <cstddef>

#include "geom/base/run_context.h"
#include "volmesh/case/limit_options.h"
#include "volmesh/layer_domain/layer_domain.h"
#include "volmesh/tetra/size_field.h"

namespace sterna::volmesh {

/// Forecast for the machine on which docs/measurements/performance.md was measured. There the memory is accurate to a quarter, and the time to a factor of two.
struct Forecast {
  double n_triangles = 0.0;   ///< triangles of the walls with layers
  double n_prisms = 0.0;      ///< cells of the layer
  double n_tetrahedra = 0.0;  ///< estimated from sizes and boundary
  double bytes() const;       ///< peak memory of the whole process
  double seconds(int threads) const;
};

/// Returns the forecast before the envelope is built: cells of the requested layer, and the smallest number of tetrahedra for walls with this number of
/// triangles.
/// \pre the options of the layer domain are validated
Forecast forecast_of(const LayerDomain& layer_domain);
/// Returns the number of tetrahedra that a size field requires, computed from its leaves. It includes tetrahedra at the boundary.
double expected_tetrahedra(const SizeField& sizes);

/// Checks the forecast against the limits. Logs a message if the run will be long.
/// \throws Error(overflow) with the numbers and the remedy if the forecast exceeds the limit; with `force` it is a warning
void require_room(const Forecast& forecast, const LimitOptions& limits, const RunContext& context);

}  // namespace sterna::volmesh
