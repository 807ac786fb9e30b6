// What a remeshed surface is like: angles, needles, distances.
#pragma once

#include "geom/mesh/tri_mesh.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

/// Angles, radius ratios and the body length.
void measure_angles(const TriMesh& mesh, RemeshReport& report);
/// From samples of `from` to the nearest place of `to`. Parallel. \param is_from_new which of the two has the new triangles
SurfaceDistance surface_distance(const TriMesh& from, const TriMesh& to, bool is_from_new, const RunContext& context);

}  // namespace sterna::surfmesh
