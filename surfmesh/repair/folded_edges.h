// Finds edges whose two facets lie on each other. A surface with many of them encloses no volume for tetrahedra.
#pragma once

#include <cstdint>

#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

/// Rad: below this angle tetrahedral engines treat two neighbouring facets as one (HXT's limit is 0.01 degrees).
inline constexpr double k_folded_angle = 1.7e-4;
/// A surface with at least this fraction of folded edges does not bound a body.
inline constexpr double k_many_folded = 0.01;

/// Counts the edges whose facets form an angle below k_folded_angle, on either side.
/// \pre manifold
std::int64_t count_folded_edges(const TriMesh& mesh);

}  // namespace sterna::surfmesh
