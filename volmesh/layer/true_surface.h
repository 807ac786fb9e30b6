// The true position of a wall between its vertices.
#pragma once

#include <array>
#include <functional>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// Returns the point of the true (CAD, analytic) surface that corresponds to a point on a triangle of the wall. The point is in metres and near the given one.
/// If the point lies on an edge, the barycentric weight of the opposite corner is exactly zero, so that edges of the model stay edges. Called from several
/// threads.
using TrueSurface = std::function<Point(const Point& on_triangle, TriangleId triangle, const std::array<double, 3>& weights)>;

}  // namespace sterna::volmesh
