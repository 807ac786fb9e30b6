// The plane in which an adjacent patch is triangulated: its own, or the projection plane of a curved patch.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/surface.h"
#include "volmesh/rims/end_surface.h"

namespace sterna::volmesh {

/// Frame of a plane. Right-handed: x, y, normal are orthonormal. Along a coordinate axis all components are exactly 0 or 1 and the origin has the plane's
/// coordinate alone.
struct EndFrame {
  Point origin;
  Vec3 x, y, normal;
  Uv place(const Point& p) const { return {dot(p - origin, x), dot(p - origin, y)}; }
  double height(const Point& p) const { return dot(p - origin, normal); }
};

/// Returns a frame with this normal and origin. \param normal unit; exactly along a coordinate axis or in any direction
EndFrame end_frame_along(const Vec3& normal, const Point& origin);

/// Returns the region's plane if it is planar: a ConstraintPlane, or an original that is flat to rounding.
/// \throws Error(bad_argument) for points of loops off a ConstraintPlane
std::optional<EndFrame> plane_of(const EndRegion& region);

/// Returns the plane as a parametric surface, (u, v) = metres along x and y.
SurfacePtr plane_surface(const EndFrame& frame, const ParameterBox& box);

/// Returns the points of `surface` over the plane of `frame`, along its normal: first guess from the original's triangles, then Newton's method.
/// \pre no triangle of `original` is steeper than its projection allows; `surface` outlives the result
SurfacePtr projected_surface(const EndFrame& frame, const ParameterBox& box, const ConstraintSurface& surface, const TriMesh& original,
                             std::span<const TriangleId> triangles, const RunContext& context);

}  // namespace sterna::volmesh
