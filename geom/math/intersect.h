// Exact triangle-triangle intersection and the self-intersections of a set of triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna {

/// Whether two closed, non-degenerate triangles that share no vertex have a common point. Exact, also when coplanar or touching.
bool triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Whether two triangles of an indexed set meet in more than what their shared vertices require: anything for disjoint ones; beyond the vertex
/// for one shared vertex; overlap (same side and coplanar) for a shared edge; always for three shared vertices. Exact.
bool triangles_cross(std::span<const Vec3> points, const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b);

/// All crossing pairs (i < j), sorted; parallel over a BoxTree. At most `limit` pairs are returned (the first in order), `total` counts all.
struct CrossingPairs {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  std::int64_t total = 0;
};
CrossingPairs find_crossings(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                             const RunContext& context, std::size_t limit = static_cast<std::size_t>(-1));

}  // namespace sterna
