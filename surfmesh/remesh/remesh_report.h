// Measures a remeshed surface: angles, sliver triangles, distances.
#pragma once

#include "geom/mesh/tri_mesh.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

/// Measures angles, radius ratios and the body length.
void measure_angles(const TriMesh& mesh, RemeshReport& report);
/// Measures the distance from samples of `from` to the nearest locations on `to`. Parallel. \param is_from_new true if `from` has the new triangles, false if
/// `to` has them
SurfaceDistance surface_distance(const TriMesh& from, const TriMesh& to, bool is_from_new, const RunContext& context);

}  // namespace sterna::surfmesh
