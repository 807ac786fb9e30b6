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

/// Whether two triangles have a common point. Exact.
bool triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Whether two triangles of an indexed set meet in more than what their shared vertices require, that is, in a point outside the convex hull of the
/// shared vertices: anything for disjoint ones; beyond the vertex for one shared vertex; coplanar overlap for a shared edge; always for
/// three different shared vertices. Vertices are shared by index only: equal coordinates under two indices touch, hence cross. Exact.
/// \pre indices in range, coordinates finite.
bool triangles_cross(std::span<const Vec3> points, const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b);

}  // namespace sterna
