// The alpha wrap of a triangle soup: a closed surface around whatever the soup is. Its CGAL headers stay in cgal_wrap.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna {

struct WrapSurface {
  std::vector<Vec3> points;                             ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< normals out of the volume that it encloses
};

struct AlphaWrapInput {
  std::vector<Vec3> points;                             ///< m; finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< in range; triangles without area are left out
  double alpha = 0.0;                                   ///< m; a ball of this radius rolls around the soup: what it cannot enter is inside
  double offset = 0.0;                                  ///< m; distance of the wrap's vertices from the soup
  std::vector<Vec3> seeds;                              ///< empty: wrapped from outside; else from within the rooms that these points lie in
  std::int64_t expected_points = 0;                     ///< for the progress
  std::int64_t max_points = 0;                          ///< 0: any number
};

/// Carves the Delaunay tetrahedra from outside, gate by gate, the widest first, and inserts points at `offset` from the soup where gates are wider than alpha.
/// Serial, the same in every run. About 60 us a point. Empty when there is nothing to wrap, or when no ball of radius alpha fits around a seed.
/// \post closed, manifold, oriented, clear of itself; every vertex at `offset` from the soup but for CGAL's bisection
/// \throws Error(cancelled) between points; Error(bad_argument) when there are more than max_points; Error(geometry_failed) when CGAL gives up
/// Source: C. Portaneri, M. Rouxel-Labbe, M. Hemmer, D. Cohen-Steiner, P. Alliez, "Alpha Wrapping with an Offset", SIGGRAPH 2022.
WrapSurface alpha_wrap(const AlphaWrapInput& input, const RunContext& context);

}  // namespace sterna
