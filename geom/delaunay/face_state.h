// What the steps of mesh_face share: the surface, the triangulation that grows on it, the wanted length of edges at each vertex.
#pragma once

#include "geom/delaunay/face_mesh.h"
#include "geom/delaunay/surface_triangulation.h"

namespace sterna::delaunay {

struct FaceState {
  const Surface& surface;
  const SizeFunction& wanted;
  const FaceMeshOptions& options;
  ParameterBox box;  ///< of the border
  SurfaceTriangulation mesh;
  Column<VertexId, double> size;  ///< metres, of every vertex of `mesh`
};

SurfaceSample sample(const Surface& surface, Uv at);

/// What is wanted at a place, not below min_edge.
/// \throws Error(bad_argument) when it is not positive
double wanted_size(const FaceState& state, Uv at, const Point& point);

/// Parameters, and the sample there, near `target`, by Newton's method on the tangent plane from `guess`; held within the box of the border.
/// `tolerance`: metres along the surface.
Uv approach(const FaceState& state, const Point& target, Uv guess, double tolerance, SurfaceSample& at_result);

/// Change of (u, v) that moves a point of this frame by `step` along the tangent plane; zero where the frame is degenerate.
Uv parameter_step(const SurfaceFrame& frame, const Vec3& step);

}  // namespace sterna::delaunay
