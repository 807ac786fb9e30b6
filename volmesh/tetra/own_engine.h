// Our own engine (geom/tets): recovers the boundary, then makes the points in the volume, in this process and on all threads.
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/tetra/engine.h"

namespace sterna::volmesh {

/// recover() makes tetrahedra of the boundary's points; where it cannot, HXT, or TetGen where that fails, in its helper process, which log and result tell.
/// refine() fits them to the sizes. Of several regions and of sheets each face of the boundary has a tetrahedron on one side only, so the kernel needs to know
/// nothing of them. \pre check_boundary() passed; sizes \post the result is proven \throws as run_engine() does
EngineOutcome run_own_engine(const EngineInput& input, const TetraOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
