#include <algorithm>
#include <map>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "surfmesh/wrap/fit_wrap.h"

namespace sterna::surfmesh {
namespace {

constexpr int k_majority_rounds = 6;
/// Relative to the edge squared: a region with a smaller area is an island, unless it is the only region of its patch.
constexpr double k_island_area = 8.0;

}  // namespace

std::vector<std::uint32_t> patches_of(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles, const InputSurface& surface,
                                      const WrapSizes& sizes, const RunContext& context) {
  const TriMesh mesh = wrap_mesh(points, triangles);
  const Column<TriangleId, PatchId>& input_patch = surface.input().mesh.triangle_patch;
  const std::size_t n = triangles.size();
  std::vector<std::uint32_t> patch(n, 0);
  if (surface.input().mesh.patches.size() < 2) return patch;
  std::vector<double> area(n, 0.0);
  parallel_for(
      context, n,
      [&](std::size_t t) {
        const auto c = corners(mesh, TriangleId(std::uint64_t{t}));
        const Vec3 a = area_vector(c[0], c[1], c[2]);
        area[t] = norm(a);
        // The query starts outside of the surface, so that the other side of a thin wing is not nearer.
        const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0 + 0.5 * sizes.tolerance * normalized(a);
        patch[t] = input_patch[surface.nearest(middle).triangle].value();
      },
      256);
  const Topology topology(mesh, context);
  const auto neighbour = [&](std::size_t t, std::size_t k) { return triangle_of(topology.twin(HalfedgeId(std::uint64_t{3 * t + k}))).index(); };
  // A triangle beside two triangles of another patch joins that patch.
  for (int round = 0; round < k_majority_rounds; ++round) {
    std::vector<std::uint32_t> next = patch;
    parallel_for(context, n, [&](std::size_t t) {
      const std::uint32_t a = patch[neighbour(t, 0)], b = patch[neighbour(t, 1)], c = patch[neighbour(t, 2)];
      const std::uint32_t most = a == b || a == c ? a : b == c ? b : patch[t];
      // If two triangles would swap patches, only one of them changes. Therefore only changes towards the lower number are made.
      if (most != patch[t] && (a == patch[t] || b == patch[t] || c == patch[t]) && most > patch[t]) return;
      next[t] = most;
    });
    if (next == patch) break;
    patch.swap(next);
  }
  // Islands are assigned to the neighbour with the longest common border, smallest island first.
  for (int round = 0; round < k_majority_rounds; ++round) {
    std::vector<std::uint32_t> region(n, k_none), stack;
    std::vector<double> region_area;
    std::vector<std::uint32_t> region_patch;
    for (std::size_t s = 0; s < n; ++s) {
      if (region[s] != k_none) continue;
      const auto r = static_cast<std::uint32_t>(region_area.size());
      region_area.push_back(0.0);
      region_patch.push_back(patch[s]);
      region[s] = r;
      stack.push_back(static_cast<std::uint32_t>(s));
      while (!stack.empty()) {
        const std::uint32_t t = stack.back();
        stack.pop_back();
        region_area[r] += area[t];
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t o = neighbour(t, k);
          if (region[o] != k_none || patch[o] != patch[t]) continue;
          region[o] = r;
          stack.push_back(static_cast<std::uint32_t>(o));
        }
      }
    }
    std::map<std::uint32_t, std::uint32_t> largest;  // largest region of each patch
    for (std::uint32_t r = 0; r < region_area.size(); ++r) {
      const auto [known, is_new] = largest.try_emplace(region_patch[r], r);
      if (!is_new && region_area[r] > region_area[known->second]) known->second = r;
    }
    std::map<std::uint32_t, std::map<std::uint32_t, double>> borders;  // length of the border of each island with each patch
    for (std::size_t t = 0; t < n; ++t) {
      const std::uint32_t r = region[t];
      if (region_area[r] > k_island_area * sizes.edge * sizes.edge || largest[region_patch[r]] == r) continue;
      const auto c = corners(mesh, TriangleId(std::uint64_t{t}));
      for (std::size_t k = 0; k < 3; ++k)
        if (region[neighbour(t, k)] != r) borders[r][patch[neighbour(t, k)]] += distance(c[k], c[(k + 1) % 3]);
    }
    if (borders.empty()) break;
    std::map<std::uint32_t, std::uint32_t> goes_to;
    for (const auto& [r, lengths] : borders) {
      const auto longest = std::max_element(lengths.begin(), lengths.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
      goes_to[r] = longest->first;
    }
    for (std::size_t t = 0; t < n; ++t)
      if (const auto known = goes_to.find(region[t]); known != goes_to.end()) patch[t] = known->second;
  }
  return patch;
}

}  // namespace sterna::surfmesh
