// A part of a surface that was meshed or read in its own frame and was only moved and turned afterwards. Results made in that frame can be moved with the part.
#pragma once

#include <cstdint>
#include <memory>

#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/frame.h"

namespace sterna::volmesh {

struct PlacedPart {
  std::shared_ptr<const TriMesh> own;  ///< the part in its own frame, with triangles and vertices in the same order as in the surface
  Transform placement;                 ///< rotation and shift: p becomes placement.point(p); without motion, p stays bitwise unchanged
  std::uint32_t first_triangle = 0;    ///< number of its first triangle in the surface
  std::uint32_t first_vertex = 0;
  double smooth_angle = k_automatic;  ///< rad: MeshCase::smooth_angle for this part alone
};

}  // namespace sterna::volmesh
