// Data shared by the steps of mesh_face: the surface, the triangulation that grows on it, the target edge length at each vertex.
#pragma once

#include "geom/delaunay/face_mesh.h"
#include "geom/delaunay/surface_triangulation.h"

namespace sterna::delaunay {

struct FaceState {
  const Surface& surface;
  const SizeFunction& requested;
  const FaceMeshOptions& options;
  ParameterBox box;  ///< box of the border
  SurfaceTriangulation mesh;
  Column<VertexId, double> size;  ///< metres, of every vertex of `mesh`
};

SurfaceSample sample(const Surface& surface, Uv at);

/// Returns the target edge length at a location, not below min_edge.
/// \throws Error(bad_argument) if it is not positive
double target_size(const FaceState& state, Uv at, const Point& point);

/// Finds the parameters nearest to `target`, and the sample there, by Newton's method on the tangent plane from `guess`, limited to the box of the border.
/// `tolerance`: metres along the surface.
Uv approach(const FaceState& state, const Point& target, Uv guess, double tolerance, SurfaceSample& at_result);

/// Returns the change of (u, v) that moves a point of this frame by `step` along the tangent plane; zero if the frame is degenerate.
Uv parameter_step(const SurfaceFrame& frame, const Vec3& step);

}  // namespace sterna::delaunay
