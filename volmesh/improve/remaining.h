// The bad tetrahedra that improvement has left, and what of the boundary forces them.
#pragma once

#include "volmesh/improve/improve.h"

namespace sterna::volmesh {

/// Fills `n_forced` and `remaining` of the report. The angles of the boundary: between its triangles, through the domain, at the edges of the tetrahedron that lie on it,
/// and of the corners of its triangles at the tetrahedron's vertices. \pre verify_tetrahedra() passes. Parallel, O(n).
void list_remaining(const TetraBoundary& boundary, const TetraResult& tets, std::span<const std::uint32_t> bad_tets, const ImproveOptions& options, ImproveReport& report, const RunContext& context);

}  // namespace sterna::volmesh
