// Options of surface meshes for tests.
#pragma once

#include "surfmesh/model/surface_mesh.h"

namespace sterna::test {

/// Returns options for edges of at most `size` that turn by at most `angle`, radians.
inline surfmesh::SurfaceMeshOptions edges_of(double size, double angle = 0.5) {
  surfmesh::SurfaceMeshOptions options;
  options.sizes.max_edge = size;
  options.sizes.curvature_angle = angle;
  return options;
}

}  // namespace sterna::test
