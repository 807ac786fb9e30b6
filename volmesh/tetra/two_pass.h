// Target edge lengths for the second of two passes, from the first (docs/method/tetrahedra.md, "Two passes"; [ET15 §3.3]).
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/case/size_sources.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Largest ratio of circumradius to shortest edge in the first pass.
inline constexpr double k_coarse_radius_edge = 1.5;

/// Returns the sizes (m) at the nodes of a coarse mesh in the volume: the mean of their edges' lengths, smoothed over the mesh's edges with fixed values at the
/// boundary's nodes. Edges count once for each tetrahedron around them. Serial, O(n).
/// \pre verify_tetrahedra() passed.
SizeSource nodal_sizes(const TetraBoundary& boundary, const TetraResult& coarse, const RunContext& context);

}  // namespace sterna::volmesh
