// Where a wall really is, between its vertices.
#pragma once

#include <array>
#include <functional>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// The point of the true (CAD, analytic) surface that belongs to a point on a triangle of the wall; in metres, near it. Barycentric `weights`: exactly zero for
/// the corner opposite to the edge that the point is on, so that edges of the model stay edges. Called from several threads.
using TrueSurface = std::function<Point(const Point& on_triangle, TriangleId triangle, const std::array<double, 3>& weights)>;

}  // namespace sterna::volmesh
