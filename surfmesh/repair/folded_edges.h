// Edges whose two facets lie on each other: a surface full of them encloses no volume for tetrahedra.
#pragma once

#include <cstdint>

#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

/// Below this angle, in rad, tet engines treat two neighbours as one (HXT's limit is 0.01 degrees).
inline constexpr double k_folded_angle = 1.7e-4;
/// From this fraction of folded edges on, a surface does not bound a body.
inline constexpr double k_many_folded = 0.01;

/// Counts the edges with an angle below k_folded_angle between their facets, on either side.
/// \pre manifold
std::int64_t count_folded_edges(const TriMesh& mesh);

}  // namespace sterna::surfmesh
