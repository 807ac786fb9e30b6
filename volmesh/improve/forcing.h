// Boundary triangles that leave no space for a tetrahedron within the limits.
//
// A tetrahedron on triangle F with its three dihedral angles there within [low, high], high < 180 degrees, is the intersection of wedges of these angles at F's
// edges. It therefore contains the core of F: the flat pyramid under the planes at `low` through the edges. Tetrahedra on two triangles are different and have
// no interior in common, unless the triangles share an edge and the one tetrahedron is their hull. So if the cores of F and G overlap, one of the two
// tetrahedra is beyond the limits, unless that hull is within. An edge at which the domain's angle is below `low` is the case of a shared edge.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Finds, for each boundary triangle in `wanted`, a triangle whose core overlaps its own and with which it cannot share a tetrahedron; k_unforced if there is
/// none. Overlaps thinner than a thousandth of the cores do not count. Angles in radians. Parallel, O(n log n).
std::vector<std::uint32_t> forcing_triangles(const TetraBoundary& boundary, std::span<const std::uint32_t> wanted, double low, double high,
                                             const RunContext& context);
inline constexpr std::uint32_t k_unforced = 0xffffffffu;

}  // namespace sterna::volmesh
