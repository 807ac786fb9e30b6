// The first of two passes tells the second how long its edges are to be (docs/method/tetrahedra.md, "Two passes"; [ET15 §3.3]).
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/case/size_sources.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// Largest circumradius over shortest edge of the first pass.
inline constexpr double k_coarse_radius_edge = 1.5;

/// Sizes (m) at the nodes of a coarse mesh in the volume: the mean of their edges' lengths, smoothed over the mesh's edges while those of the boundary's nodes
/// stay. Edges count once for each tetrahedron around them. Serial, O(n).
/// \pre verify_tetrahedra() passed.
SizeSource nodal_sizes(const TetraBoundary& boundary, const TetraResult& coarse, const RunContext& context);

}  // namespace sterna::volmesh
