// Verifies that tetrahedra tile the domain inside a boundary.
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Verifies that node indices are in range, every new point is finite and used, and every tetrahedron is positive (exact test). Every boundary triangle must be
/// a face of exactly one tetrahedron, on the correct side. Every other face must belong to exactly two tetrahedra, on opposite sides. If the boundary has no
/// self-intersection, the tetrahedra are then a tiling. Parallel, O(n).
/// \pre check_boundary() has passed
/// \throws Error(tetra_result_invalid) with the number of violations of each kind and the first locations; overflow for more than 2^29 owners of faces
void verify_tetrahedra(const TetraBoundary& boundary, const TetraResult& result, const RunContext& context);

}  // namespace sterna::volmesh
