// Periodic sides of a mesh: two patches, one a translated copy of the other.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

/// Largest distance of a node's image from its partner, relative to the size of the mesh (longest side of its box, or the body length if known).
inline constexpr double k_periodic_share = 1e-10;

struct PeriodicMatch {
  Vec3 translation;                                 ///< m, from the first patch to the second
  std::vector<std::array<NodeId, 2>> nodes;         ///< partners, ascending by the first
  std::vector<std::array<std::uint32_t, 2>> faces;  ///< partners among the boundary triangles, then among the quadrilaterals of the mesh (numbered behind the
                                                    ///< triangles)
  double worst = 0.0;                               ///< m, largest distance of an image from its partner
};

/// Returns k_periodic_share times the longest side of the mesh's box, m.
double periodic_tolerance(const HybridMesh& mesh);

/// Matches nodes and faces of two patches. The translation is that between the centres of their nodes. \p tolerance: metres. Serial, O(n log n).
/// \throws Error(bad_argument) with locations for an empty patch, a node or a face without partner, and a patch that is not flat within the tolerance
PeriodicMatch match_periodic(const HybridMesh& mesh, PatchId first, PatchId second, double tolerance);
/// Matches two patches of a surface in the same way: its vertices are the nodes.
PeriodicMatch match_periodic(const TriMesh& surface, PatchId first, PatchId second, double tolerance);

}  // namespace sterna
