// Finds boundary triangles that leave no space for a tetrahedron within the limits.
//
// Consider a tetrahedron on triangle F whose three dihedral angles at F are within [low, high], with high < 180 degrees. It is the intersection of wedges of
// these angles at the edges of F. It therefore contains the core of F: the flat pyramid below the planes at the angle `low` through the edges. Tetrahedra on
// two triangles are different and have no interior in common, unless the triangles share an edge and their hull is a single tetrahedron on both. So if the
// cores of F and G overlap, one of the two tetrahedra is beyond the limits, unless that hull is within the limits. This includes edges at which the angle of
// the domain is below `low`: the triangles then share that edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Finds triangles that force a bad tetrahedron. For each boundary triangle in `target`, returns another boundary triangle whose core overlaps its core, and
/// that cannot be a face of the same tetrahedron; k_unforced if there is none. Overlaps thinner than a thousandth of the cores are ignored. Angles are in
/// radians. Parallel, O(n log n).
std::vector<std::uint32_t> forcing_triangles(const TetraBoundary& boundary, std::span<const std::uint32_t> target, double low, double high,
                                             const RunContext& context);
inline constexpr std::uint32_t k_unforced = 0xffffffffu;

}  // namespace sterna::volmesh
