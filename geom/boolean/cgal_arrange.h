// Triangles that cross, cut along their intersections. One of the doors to CGAL: its headers stay in cgal_arrange.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna {

struct Arrangement {
  std::vector<Vec3> points;                             ///< those given, then the new ones, each rounded to the nearest double
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< those that cross nothing as they were, then the pieces
  std::vector<std::uint32_t> parent;                    ///< per triangle: the one given that it is a piece of; same sense
};

/// Cuts every triangle of `pairs` along its intersections with its partners: pieces meet in common vertices and edges only. Where triangles of one plane
/// overlap, each has the same pieces there. Exact constructions (CGAL), rounded once at the end: rounding may make a few pieces cross or lose their area; the
/// caller looks. Serial, one result for any number of threads. About 0.2 ms a pair.
/// \pre triangles have an area; `pairs` are all pairs that cross (find_crossings), coordinates finite
/// \throws Error(cancelled); Error(geometry_failed) when CGAL gives up
Arrangement arrange_triangles(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                              std::span<const std::array<std::uint32_t, 2>> pairs, const RunContext& context);

}  // namespace sterna
