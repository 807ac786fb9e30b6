// Meshes planes that complete the fluid's boundary and on which no layer ends. They get new vertices, from the edges of the body to those of the farfield.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/end_options.h"
#include "volmesh/domain/complete_boundary.h"

namespace sterna::volmesh {

struct PlaneSizes {
  EndOptions ends;
  std::function<double(const Point&)> size = {};  ///< longest edge at a location, m; may be empty
};

/// Triangulates added planes within their borders as close_boundary() does around layers: edges grow by `ends_growth` from the borders, up to the edge length
/// of the plane and to `size`. Planes on which layers end are not changed here, because close_boundary() triangulates them. New vertices and the triangles of
/// the planes come last in the boundary. \param n_given number of the user's triangles, which come first and are unchanged
/// \throws the errors of triangulate_adjacent()
void mesh_bare_planes(std::span<const AddedPlane> planes, std::size_t n_given, const Column<PatchId, std::uint8_t>& has_layer, const PlaneSizes& sizes,
                      TriMesh& boundary, const RunContext& context);

}  // namespace sterna::volmesh
