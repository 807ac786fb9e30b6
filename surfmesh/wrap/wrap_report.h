// Private to surfmesh/wrap: what a wrap changed, how far it is from its input, and the proof that it can be meshed.
#pragma once

#include "surfmesh/wrap/fit_wrap.h"

namespace sterna::surfmesh {

/// Distances, closures, what is inside, leaks, quality; messages about them.
void measure_wrap(const FittedWrap& wrap, const InputSurface& surface, const WrapSizes& sizes, WrapReport& report, const RunContext& context);

/// \throws Error unless the mesh is manifold, clear of itself and closed; with a half model: open in its plane only
void prove_wrap(const TriMesh& mesh, const WrapReport& report, const RunContext& context);

}  // namespace sterna::surfmesh
