// Sterna's own engine (geom/tets). It recovers the boundary, then inserts the points in the volume, in this process and on all threads.
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/tetra/engine.h"

namespace sterna::volmesh {

/// Runs recover(), which makes tetrahedra of the boundary's points, then refine(), which adapts them to the sizes. If recover() fails, HXT recovers the
/// boundary in its helper process, or TetGen if HXT also fails; log and result report this. With several regions and with sheets, each face of the boundary has
/// a tetrahedron on one side only, so the kernel needs no data on regions and sheets. \pre check_boundary() has passed; sizes are given \post the result is
/// verified \throws the errors of run_engine()
EngineOutcome run_own_engine(const EngineInput& input, const TetraOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
