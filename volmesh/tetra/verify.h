// Verification that tetrahedra tile the domain inside a boundary.
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Verifies that node indices are in range, every new point is finite and used, every tet is positive (exact), every boundary triangle is a face of exactly one
/// tet from the right side, and every other face belongs to exactly two tets from opposite sides. With a boundary free of self-intersection that is a tiling.
/// Parallel, O(n).
/// \pre check_boundary() passed.
/// \throws Error(tetra_result_invalid) with the number of violations of each kind and the first locations; overflow beyond 2^29 faces' owners.
void verify_tetrahedra(const TetraBoundary& boundary, const TetraResult& result, const RunContext& context);

}  // namespace sterna::volmesh
