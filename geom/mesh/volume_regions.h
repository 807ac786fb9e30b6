// Connected regions of a volume mesh: separate fluid volumes, such as the inside of a sealed cavity.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

struct VolumeRegion {
  double volume = 0.0;               ///< m^3
  Box box;                           ///< bounding box of its nodes
  std::vector<std::string> patches;  ///< on its boundary, in the order of the mesh
};

/// Returns the regions of cells that share no node with each other, largest volume first. The two sides of a disc belong together. Volumes are computed from
/// the boundary triangles; a quadrilateral counts as two triangles. Empty for a mesh without boundary. Serial. The time is linear in the number of boundary
/// faces if there is one region, else in the number of cells.
/// \pre indices in range
std::vector<VolumeRegion> volume_regions(const HybridMesh& mesh);

/// Returns "2 that are not connected: 2.97 m^3 (patches box), 0.0335 m^3 (patches sphere)"; empty for one region.
std::string describe_regions(const std::vector<VolumeRegion>& regions);

}  // namespace sterna
