// The plane in which an adjacent patch is triangulated: its own plane, or the projection plane of a curved patch.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/surface.h"
#include "volmesh/adjacent/adjacent_surface.h"

namespace sterna::volmesh {

/// Right-handed frame of a plane: x, y and normal are orthonormal. If the normal is along a coordinate axis, all components are exactly 0 or 1, and only one
/// component of the origin, the coordinate of the plane, is non-zero.
struct AdjacentFrame {
  Point origin;
  Vec3 x, y, normal;
  Uv location(const Point& p) const { return {dot(p - origin, x), dot(p - origin, y)}; }
  double height(const Point& p) const { return dot(p - origin, normal); }
};

/// Returns a frame with this normal and origin. \param normal unit, exactly along a coordinate axis or in any other direction
AdjacentFrame adjacent_frame_along(const Vec3& normal, const Point& origin);

/// Returns the region's plane if it is planar, that is, if its surface is a ConstraintPlane or its original is flat except for rounding.
/// \throws Error(bad_argument) for points of loops that are not on a ConstraintPlane
std::optional<AdjacentFrame> plane_of(const AdjacentRegion& region);

/// Returns the plane as a parametric surface, (u, v) = metres along x and y.
SurfacePtr plane_surface(const AdjacentFrame& frame, const ParameterBox& box);

/// Returns the points of `surface` over the plane of `frame`, along its normal. The first guess comes from the original's triangles; Newton's method improves
/// it.
/// \pre no triangle of `original` is steeper than its projection allows
SurfacePtr projected_surface(const AdjacentFrame& frame, const ParameterBox& box, Borrowed<const ConstraintSurface> surface, const TriMesh& original,
                             std::span<const TriangleId> triangles, const RunContext& context);

}  // namespace sterna::volmesh
