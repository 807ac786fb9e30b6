// Triangulates holes in surfaces. One of the interfaces to CGAL, whose headers stay in cgal_fill_hole.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna {

struct HolePatch {
  std::vector<Vec3> points;                             ///< new points; numbered after those of the loop
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< empty if no triangulation was found; the triangle at a loop edge runs along it from loop[i] to
                                                        ///< loop[i + 1]
};

/// Fills the region enclosed by closed loops in one plane (even-odd rule: a loop inside another bounds a hole) by a constrained Delaunay triangulation without
/// new points. The points of the loops are numbered consecutively. The result is empty if loops cross.
/// \pre loops neither touch nor cross; they are projected along `normal`
HolePatch fill_flat(const std::vector<std::vector<Vec3>>& loops, const Vec3& normal);

/// Neighbourhood of the hole: triangles of the surface around it with their own points; the first loop.size() points are those of the loop.
struct HoleBorder {
  std::vector<Vec3> points;
  std::uint32_t n_loop = 0;  ///< the hole runs along points 0 -> 1 -> ... -> n_loop - 1 -> 0; surface triangles have those edges reversed
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< a consistent, manifold neighbourhood, may be empty
};

/// Triangulates the loop with minimum area and bending. With `is_smooth`, new points are added with the spacing of the boundary points, and positioned so that
/// the surface continues without a kink (Liepa 2003, by CGAL). No points are added if the neighbourhood is not manifold. O(n^3) for n loop points.
HolePatch fill_curved(const HoleBorder& border, bool is_smooth);

}  // namespace sterna
