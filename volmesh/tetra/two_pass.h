// Target edge lengths for the second of two passes, computed from the first pass (docs/method/tetrahedra.md, "Two passes"; [ET15 §3.3]).
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/case/size_sources.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Largest ratio of circumradius to shortest edge in the first pass.
inline constexpr double k_coarse_radius_edge = 1.5;

/// Returns the sizes (m) at the nodes of a coarse mesh in the volume. A size is the mean length of the edges at the node, smoothed along the edges of the mesh
/// with fixed values at the boundary's nodes. An edge counts once for each tetrahedron around it. Serial, O(n).
/// \pre verify_tetrahedra() has passed
SizeSource nodal_sizes(const TetraBoundary& boundary, const TetraResult& coarse, const RunContext& context);

}  // namespace sterna::volmesh
