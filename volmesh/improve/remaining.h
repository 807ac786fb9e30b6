// Finds the bad tetrahedra that remain after the improvement, and the parts of the boundary that force them.
#pragma once

#include <span>

#include "volmesh/improve/improve.h"

namespace sterna::volmesh {

/// Fills `n_forced`, `n_bad_free_after` and `remaining` of the report. A tetrahedron is forced in two cases. Either one of its edges lies on the boundary, and
/// the angle of the domain there is below the smallest allowed angle (all tetrahedra at the edge share that angle). Or it lies on a boundary triangle without
/// enough space (forcing.h). For other tetrahedra, the sharpest angle of the boundary nearby is reported: the angle through the domain between boundary
/// triangles at an edge of the tetrahedron, or a corner angle of a boundary triangle at one of its vertices. A sharp corner alone forces nothing, because
/// slender tetrahedra with good dihedral angles fit it. \p bad_tets tetrahedra beyond the limits.
/// \pre verify_tetrahedra() passes. Parallel, O(n log n).
void list_remaining(const TetraBoundary& boundary, const TetraResult& tets, std::span<const std::uint32_t> bad_tets, const ImproveOptions& options,
                    ImproveReport& report, const RunContext& context);

}  // namespace sterna::volmesh
