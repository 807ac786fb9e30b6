// Where a wall really is, between its vertices.
#pragma once

#include <functional>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"

namespace sterna::volmesh {

/// The point of the true (CAD, analytic) surface that belongs to a point on a triangle of this patch of the wall; in metres, near it. Called from several threads.
using TrueSurface = std::function<Point(const Point& on_triangle, PatchId patch)>;

}  // namespace sterna::volmesh
