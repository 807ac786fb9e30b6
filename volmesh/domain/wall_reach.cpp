#include "volmesh/domain/wall_reach.h"

#include <algorithm>
#include <queue>

namespace sterna::volmesh {
namespace {

constexpr double k_near_edges = 8.0;

}  // namespace

WallReach::WallReach(const TriMesh& wall) : neighbours_(wall.n_vertices()), mean_edge_(wall.n_vertices(), 0.0) {
  for (const TriangleVertices& t : wall.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = t[k], b = t[(k + 1) % 3];
      const double length = distance(wall.points[a], wall.points[b]);
      neighbours_[a].emplace_back(b, length);
      neighbours_[b].emplace_back(a, length);
      mean_edge_[a] += length;
      mean_edge_[b] += length;
    }
  }
  for (const VertexId v : mean_edge_.ids()) mean_edge_[v] /= static_cast<double>(std::max<std::size_t>(neighbours_[v].size(), 1));
}

void WallReach::mark(std::span<const VertexId> from, std::int32_t surface, const std::function<bool(VertexId)>& may_pass,
                     Column<VertexId, std::uint64_t>& near) const {
  if (surface >= k_max_masked) return;
  const std::uint64_t bit = std::uint64_t{1} << surface;
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const VertexId v : from) queue.emplace(0.0, v.value());
  while (!queue.empty()) {
    const auto [reached, number] = queue.top();
    queue.pop();
    const VertexId v(number);
    if ((near[v] & bit) != 0 || reached > k_near_edges * mean_edge_[v]) continue;
    near[v] |= bit;
    for (const auto& [other, length] : neighbours_[v])
      if ((near[other] & bit) == 0 && (!may_pass || may_pass(other))) queue.emplace(reached + length, other.value());
  }
}

}  // namespace sterna::volmesh
