// Cuts crossing triangles along their intersections. One of the interfaces to CGAL, whose headers stay in cgal_arrange.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna {

struct Arrangement {
  std::vector<Vec3> points;                             ///< the given points, then the new ones, each rounded to the nearest double
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< unchanged triangles that cross nothing, then the pieces
  std::vector<std::uint32_t> parent;                    ///< per triangle: the given triangle that it is a piece of; same orientation
};

/// Cuts every triangle of `pairs` along its intersections with its partners: pieces meet only in common vertices and edges. Where coplanar triangles overlap,
/// all have the same pieces. Exact constructions (CGAL), rounded once at the end. Rounding may make a few pieces cross or lose their area; the caller must
/// check. Serial; the result is the same for any number of threads. About 0.2 ms per pair.
/// \pre triangles have a positive area; `pairs` are all pairs that cross (find_crossings), coordinates finite
/// \throws Error(cancelled); Error(geometry_failed) if CGAL fails
Arrangement arrange_triangles(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                              std::span<const std::array<std::uint32_t, 2>> pairs, const RunContext& context);

}  // namespace sterna
