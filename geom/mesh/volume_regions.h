// Connected regions of a volume mesh: fluid that no other fluid reaches, as the inside of a sealed cavity.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

struct VolumeRegion {
  double volume = 0.0;               ///< m^3
  Box box;                           ///< of its nodes
  std::vector<std::string> patches;  ///< on its boundary, in the order of the mesh
};

/// Regions of cells that share no node with each other, by volume, the largest first. The two sides of a disc belong together. Volumes by the boundary's
/// triangles; quadrilaterals count as two. Empty for a mesh without boundary. Serial; linear in the number of boundary faces for one region, of cells for more.
/// \pre indices in range
std::vector<VolumeRegion> volume_regions(const HybridMesh& mesh);

/// "2 that are not connected: 2.97 m^3 (patches box), 0.0335 m^3 (patches sphere)"; empty for one region.
std::string describe_regions(const std::vector<VolumeRegion>& regions);

}  // namespace sterna
