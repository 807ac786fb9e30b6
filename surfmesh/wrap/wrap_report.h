// Private to surfmesh/wrap: measures the changes made by a wrap and its distance from the input, and checks that it can be meshed.
#pragma once

#include "surfmesh/wrap/fit_wrap.h"

namespace sterna::surfmesh {

/// Measures distances, closures, enclosed facets, leaks and quality. Writes messages about them.
void measure_wrap(const FittedWrap& wrap, const InputSurface& surface, const WrapSizes& sizes, WrapReport& report, const RunContext& context);

/// \throws Error if the mesh is not manifold, crosses itself or is not closed. A half model must be open in its plane, and only there
void prove_wrap(const TriMesh& mesh, const WrapReport& report, const RunContext& context);

}  // namespace sterna::surfmesh
