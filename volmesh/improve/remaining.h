// Bad tetrahedra that remain after improvement, and the parts of the boundary that force them.
#pragma once

#include <span>

#include "volmesh/improve/improve.h"

namespace sterna::volmesh {

/// Fills `n_forced`, `n_bad_free_after` and `remaining` of the report. A tetrahedron is forced if one of its edges lies on the boundary where the domain's
/// angle is below the smallest allowed (all tetrahedra there share that angle), or if it lies on a boundary triangle without enough space (forcing.h). For
/// other tetrahedra, the sharpest angle of the boundary nearby is reported: between its triangles, through the domain, at the tetrahedron's edges, or of a
/// triangle's corner at its vertices. A sharp corner alone forces nothing, because slender tetrahedra with good dihedral angles fit it. \p bad_tets all beyond
/// the limits.
/// \pre verify_tetrahedra() passes. Parallel, O(n log n).
void list_remaining(const TetraBoundary& boundary, const TetraResult& tets, std::span<const std::uint32_t> bad_tets, const ImproveOptions& options,
                    ImproveReport& report, const RunContext& context);

}  // namespace sterna::volmesh
