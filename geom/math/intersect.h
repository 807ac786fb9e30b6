// Exact triangle-triangle intersection.
// Triangles are closed point sets, also when they touch or are coplanar; a triangle without area (collinear or repeated corners) is the segment or
// point that it covers. Range of coordinates: as for orient3d.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna {

/// Returns true if two triangles have a common point. Exact.
bool triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Returns true if two triangles of an indexed set have a common point outside the convex hull of their shared vertices. For disjoint triangles this is any
/// common point, for one shared vertex any other common point, for a shared edge a coplanar overlap. For three different shared vertices the result is always
/// true. Vertices are shared by index only: equal coordinates under two indices touch and therefore cross. Exact.
/// \pre indices in range, coordinates finite
bool triangles_cross(std::span<const Vec3> points, const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b);

}  // namespace sterna
