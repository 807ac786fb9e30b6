// Alpha wrap of a triangle soup: a closed surface around any soup. Its CGAL headers stay in cgal_wrap.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna {

struct WrapSurface {
  std::vector<Vec3> points;                             ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< normals point out of the enclosed volume
};

struct AlphaWrapInput {
  std::vector<Vec3> points;                             ///< m; finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices in range; triangles of zero area are ignored
  double alpha = 0.0;                                   ///< m; radius of a ball that rolls around the soup; regions that the ball cannot enter are inside
  double offset = 0.0;                                  ///< m; distance of the wrap's vertices from the soup
  std::vector<Vec3> seeds;                              ///< points in cavities to be wrapped from inside; empty: the soup is wrapped from outside
  std::int64_t expected_points = 0;                     ///< for the progress report
  std::int64_t max_points = 0;                          ///< 0: no limit
};

/// Carves the Delaunay tetrahedra from outside, gate by gate, the widest gate first, and inserts points at `offset` from the soup where gates are wider than
/// alpha. Serial, the same in every run. About 60 us per point. The result is empty if the soup is empty or no ball of radius alpha fits around a seed.
/// \post closed, manifold, oriented, free of self-intersections; every vertex at `offset` from the soup up to the accuracy of CGAL's bisection
/// \throws Error(cancelled) between points; Error(bad_argument) if there are more than max_points; Error(geometry_failed) if CGAL fails
/// Source: C. Portaneri, M. Rouxel-Labbe, M. Hemmer, D. Cohen-Steiner, P. Alliez, "Alpha Wrapping with an Offset", SIGGRAPH 2022.
WrapSurface alpha_wrap(const AlphaWrapInput& input, const RunContext& context);

}  // namespace sterna
