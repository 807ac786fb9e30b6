// Crossing pairs of a set of triangles: each triangle queries the box tree for those of higher number, exact test on each.
#include <algorithm>
#include <string>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/bvh.h"
#include "geom/math/intersect.h"

namespace sterna {
namespace {

/// Triangles per task: about 1 ms.
constexpr std::size_t k_chunk = 512;

void check_input(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles) {
  const auto fail = [](const std::string& problem) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = "looking for crossing triangles", .problem = problem});
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t v : triangles[t]) {
      if (v >= points.size()) fail("triangle " + std::to_string(t) + " refers to point " + std::to_string(v) + " of " + std::to_string(points.size()));
      if (!is_finite(points[v])) fail("point " + std::to_string(v) + " of triangle " + std::to_string(t) + " is not finite");
    }
  }
}

}  // namespace

CrossingPairs find_crossings(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                             const RunContext& context, std::size_t limit) {
  check_input(points, triangles);
  std::vector<Box> boxes(triangles.size());
  parallel_for(context, triangles.size(), [&](std::size_t t) {
    for (const std::uint32_t v : triangles[t]) boxes[t].add(points[v]);
  });
  const BoxTree tree(boxes, context);

  // Chunks are in the order of the first triangle, so the pairs come out sorted and the first `limit` of each chunk suffice.
  const auto crossings_of = [&](std::size_t begin, std::size_t end) {
    CrossingPairs found;
    std::vector<std::uint32_t> partners;
    for (std::size_t t = begin; t < end; ++t) {
      const auto i = static_cast<std::uint32_t>(t);
      partners.clear();
      tree.for_each_overlap(boxes[t], [&](std::uint32_t j) {
        if (j > i && triangles_cross(points, triangles[i], triangles[j])) partners.push_back(j);
        return true;
      });
      std::sort(partners.begin(), partners.end());
      found.total += static_cast<std::int64_t>(partners.size());
      for (const std::uint32_t j : partners) {
        if (found.pairs.size() < limit) found.pairs.push_back({i, j});
      }
    }
    return found;
  };
  const auto append = [limit](CrossingPairs all, CrossingPairs more) {
    const std::size_t n = std::min(more.pairs.size(), limit - all.pairs.size());
    all.pairs.insert(all.pairs.end(), more.pairs.begin(), more.pairs.begin() + static_cast<std::ptrdiff_t>(n));
    all.total += more.total;
    return all;
  };
  return parallel_reduce(context, triangles.size(), CrossingPairs{}, crossings_of, append, k_chunk);
}

}  // namespace sterna
