// What a mesh will have and need, before it is made; more than the machine has is an error at once.
#pragma once

#include <cstddef>

#include "geom/base/run_context.h"
#include "volmesh/case/limit_options.h"
#include "volmesh/site/site.h"
#include "volmesh/tetra/size_field.h"

namespace sterna::volmesh {

/// Figures of the machine that docs/performance.md was measured on; memory within a quarter there, time within a factor of two.
struct Forecast {
  double n_triangles = 0.0;   ///< of the walls with layers
  double n_prisms = 0.0;      ///< cells of the layer
  double n_tetrahedra = 0.0;  ///< as good as sizes and boundary tell
  double bytes() const;       ///< at the peak, the whole process
  double seconds(int threads) const;
};

/// Before the envelope: cells of the layer as asked for, and the fewest tetrahedra that walls of so many triangles have.
/// \pre options of the site validated
Forecast forecast_of(const MeshingSite& site);
/// Tetrahedra that a size field asks for, by its leaves; the boundary's own are among them.
double expected_tetrahedra(const SizeField& sizes);

/// Tells a long run.
/// \throws Error(overflow) with the figures and what to change where the forecast is above what is allowed; with `force` a warning
void require_room(const Forecast& forecast, const LimitOptions& limits, const RunContext& context);

}  // namespace sterna::volmesh
