// Our own engine: another one recovers the boundary, our kernel (geom/tets) makes the points in the volume.
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/tetra/engine.h"

namespace sterna::volmesh {

/// HXT, or TetGen where that fails, makes tetrahedra of the boundary's points alone, in its helper process; refine() fits them to the sizes, on all threads.
/// Of several regions and of sheets each face of the boundary has a tetrahedron on one side only, so the kernel needs to know nothing of them.
/// \pre check_boundary() passed; sizes
/// \post the result is proven
/// \throws as run_engine() does
EngineOutcome run_own_engine(const EngineInput& input, const TetraOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
