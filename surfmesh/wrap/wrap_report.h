// Private to surfmesh/wrap: changes made by a wrap, its distance from the input, and the proof that it can be meshed.
#pragma once

#include "surfmesh/wrap/fit_wrap.h"

namespace sterna::surfmesh {

/// Measures distances, closures, enclosed facets, leaks and quality, and writes messages about them.
void measure_wrap(const FittedWrap& wrap, const InputSurface& surface, const WrapSizes& sizes, WrapReport& report, const RunContext& context);

/// \throws Error unless the mesh is manifold, free of self-intersection and closed; a half model must be open in its plane only
void prove_wrap(const TriMesh& mesh, const WrapReport& report, const RunContext& context);

}  // namespace sterna::surfmesh
