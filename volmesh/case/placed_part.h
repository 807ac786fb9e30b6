// A part of a surface that was meshed or read in a frame of its own and then only moved and turned: what is made of it there can be moved after it.
#pragma once

#include <cstdint>
#include <memory>

#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/frame.h"

namespace sterna::volmesh {

struct PlacedPart {
  std::shared_ptr<const TriMesh> own;  ///< in its own frame: triangles and vertices in the order in which the surface has them
  Transform placement;                 ///< rotation and shift; p -> placement.point(p), without any motion p itself
  std::uint32_t first_triangle = 0;    ///< of the surface
  std::uint32_t first_vertex = 0;
  double smooth_angle = k_automatic;  ///< rad: MeshCase::smooth_angle of the part alone
};

}  // namespace sterna::volmesh
