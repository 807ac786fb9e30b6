#include "surfmesh/wrap/move_clear.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"

namespace sterna::surfmesh {
namespace {

/// Number of halvings of the distance before a vertex stays at its start.
constexpr int k_halvings = 4;

using Corners = std::array<Vec3, 3>;

double least_angle_of(const Corners& c) { return std::min({corner_angle(c[0], c[1], c[2]), corner_angle(c[1], c[2], c[0]), corner_angle(c[2], c[0], c[1])}); }

}  // namespace

ClearMove move_clear(std::vector<Vec3> points, const std::vector<std::array<std::uint32_t, 3>>& triangles, const std::vector<Vec3>& targets,
                     const ClearMoveLimits& limits, const RunContext& context) {
  const std::vector<Vec3> home = points;
  const std::size_t n = points.size();
  std::vector<int> halvings(n, 0);  // halvings of each vertex; k_halvings: the vertex is at its start
  const auto put = [&](std::size_t v) {
    points[v] = halvings[v] == 0 ? targets[v] : halvings[v] >= k_halvings ? home[v] : home[v] + std::ldexp(1.0, -halvings[v]) * (targets[v] - home[v]);
  };
  const auto take_back = [&](std::size_t v) {
    if (halvings[v] >= k_halvings) return;
    halvings[v] = limits.is_whole ? k_halvings : halvings[v] + 1;
    put(v);
  };
  for (std::size_t v = 0; v < n; ++v) {
    if (targets[v] == home[v]) halvings[v] = k_halvings;
    put(v);
  }
  const double least_cosine = std::cos(limits.max_turn);
  while (true) {
    context.check_stop();
    const auto bad = parallel_collect<std::uint32_t>(context, triangles.size(), [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& list) {
      for (std::size_t t = begin; t < end; ++t) {
        const auto& v = triangles[t];
        if (halvings[v[0]] >= k_halvings && halvings[v[1]] >= k_halvings && halvings[v[2]] >= k_halvings) continue;
        const Corners before{home[v[0]], home[v[1]], home[v[2]]}, after{points[v[0]], points[v[1]], points[v[2]]};
        const Vec3 a = area_vector(before[0], before[1], before[2]), b = area_vector(after[0], after[1], after[2]);
        const bool has_turned = !(dot(a, b) > least_cosine * norm(a) * norm(b));
        if (has_turned || least_angle_of(after) < std::min(limits.least_angle, 0.5 * least_angle_of(before))) list.push_back(static_cast<std::uint32_t>(t));
      }
    });
    if (!bad.empty()) {
      std::vector<std::uint32_t> farthest;
      for (const std::uint32_t t : bad) {
        const auto& v = triangles[t];
        const auto way = [&](std::uint32_t w) { return halvings[w] >= k_halvings ? -1.0 : norm2(points[w] - home[w]); };
        std::uint32_t most = v[0];
        for (const std::uint32_t w : v)
          if (way(w) > way(most) || (way(w) == way(most) && w < most)) most = w;
        farthest.push_back(most);
      }
      std::sort(farthest.begin(), farthest.end());
      farthest.erase(std::unique(farthest.begin(), farthest.end()), farthest.end());
      for (const std::uint32_t v : farthest) take_back(v);
      continue;
    }
    const CrossingPairs crossings = find_crossings(points, triangles, context);
    if (crossings.total == 0) break;
    std::vector<std::uint32_t> movers;
    for (const auto& pair : crossings.pairs)
      for (const std::uint32_t t : pair)
        for (const std::uint32_t v : triangles[t]) movers.push_back(v);
    std::sort(movers.begin(), movers.end());
    movers.erase(std::unique(movers.begin(), movers.end()), movers.end());
    bool has_changed = false;
    for (const std::uint32_t v : movers) {
      has_changed |= halvings[v] < k_halvings;
      take_back(v);
    }
    if (!has_changed) break;  // the remaining pairs crossed before the move
  }
  ClearMove result;
  result.has_arrived.resize(n);
  for (std::size_t v = 0; v < n; ++v) result.has_arrived[v] = halvings[v] == 0 || targets[v] == home[v];
  result.points = std::move(points);
  return result;
}

}  // namespace sterna::surfmesh
