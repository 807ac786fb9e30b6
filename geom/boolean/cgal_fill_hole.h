// Triangles for the holes of surfaces. One of the doors to CGAL: its headers stay in cgal_fill_hole.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna {

struct HolePatch {
  std::vector<Vec3> points;                             ///< new ones; numbered behind the loop's
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< empty when nothing was found; sense: a triangle runs along loop[i] -> loop[i + 1]
};

/// Fills the region that closed loops in one plane enclose (even-odd: a loop in another is the rim of what stays open) by a constrained Delaunay triangulation
/// without new points. Loops are numbered through. \pre loops do not touch nor cross; they are projected along `normal`. Empty when they do cross.
HolePatch fill_flat(const std::vector<std::vector<Vec3>>& loops, const Vec3& normal);

/// The rim's surroundings: triangles of the surface about the hole with points of their own; the first loop.size() points are the loop's.
struct HoleRim {
  std::vector<Vec3> points;
  std::uint32_t n_loop = 0;  ///< the hole runs along points 0 -> 1 -> ... -> n_loop - 1 -> 0; surface triangles have those edges reversed
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< a consistent, manifold neighbourhood, may be empty
};

/// Triangulates the loop with least area and bend; with `is_smooth`, new points as dense as the rim's are added and placed so that the surface goes on without
/// a kink (Liepa 2003, by CGAL). Where the neighbourhood is not manifold, without new points. O(n^3) for n loop points.
HolePatch fill_curved(const HoleRim& rim, bool is_smooth);

}  // namespace sterna
