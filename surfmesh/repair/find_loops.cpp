// The boundary consists of edges with an odd number of facets. At every vertex the number of such edges is even, so they form closed polygons. If a walk along
// them returns to one of its vertices, the polygon is cut off there. Each polygon is therefore simple, and two holes that touch in a vertex stay two holes.
#include <algorithm>
#include <cmath>

#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

struct OddEdge {
  std::uint32_t from = 0, to = 0;  ///< direction against the facet
};

}  // namespace

std::vector<std::vector<std::uint32_t>> find_loops(const RepairState& state) {
  const EdgeTable table = state.edges();
  std::vector<OddEdge> edges;
  for (const Edge& edge : table.edges()) {
    if (edge.count % 2 == 0) continue;
    const std::uint32_t h = table.at(edge)[0];
    edges.push_back({state.facets[h / 3][next_halfedge(h) % 3], state.facets[h / 3][h % 3]});
  }
  std::vector<std::vector<std::uint32_t>> at(state.points.size());
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    at[edges[e].from].push_back(e);
    at[edges[e].to].push_back(e);
  }
  std::vector<char> is_used(edges.size(), 0);
  std::vector<std::uint32_t> location(state.points.size(), 0xffffffffu);  // index of each point in the walk
  std::vector<std::vector<std::uint32_t>> loops;
  for (std::uint32_t start = 0; start < edges.size(); ++start) {
    if (is_used[start]) continue;
    std::vector<std::uint32_t> walk{edges[start].from};
    location[edges[start].from] = 0;
    std::uint32_t e = start;
    while (true) {
      is_used[e] = 1;
      const std::uint32_t from = walk.back();
      const std::uint32_t v = edges[e].from == from ? edges[e].to : edges[e].from;
      if (location[v] != 0xffffffffu) {
        std::vector<std::uint32_t> loop(walk.begin() + location[v], walk.end());
        for (std::size_t i = location[v] + 1; i < walk.size(); ++i) location[walk[i]] = 0xffffffffu;
        walk.resize(location[v] + 1);
        loops.push_back(std::move(loop));
      } else {
        location[v] = static_cast<std::uint32_t>(walk.size());
        walk.push_back(v);
      }
      // If there is a choice, the walk continues in the direction of the facets, else to the side that bends back most.
      const Vec3 back = state.points[from] - state.points[v];
      std::uint32_t next = 0xffffffffu;
      double best = 1e300;
      for (const std::uint32_t f : at[walk.back()]) {
        if (is_used[f]) continue;
        const bool is_along = edges[f].from == walk.back();
        const std::uint32_t w = is_along ? edges[f].to : edges[f].from;
        const double score = angle_between(back, state.points[w] - state.points[v]) + (is_along ? 0.0 : 10.0);
        if (score < best) {
          best = score;
          next = f;
        }
      }
      if (next == 0xffffffffu) break;
      e = next;
    }
    for (const std::uint32_t v : walk) location[v] = 0xffffffffu;
  }
  // A loop gets the direction of most of its edges.
  for (auto& loop : loops) {
    std::int64_t balance = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
      for (const std::uint32_t e : at[loop[i]]) {
        const std::uint32_t w = loop[(i + 1) % loop.size()];
        if (edges[e].from == loop[i] && edges[e].to == w) ++balance;
        if (edges[e].to == loop[i] && edges[e].from == w) --balance;
      }
    if (balance < 0) std::reverse(loop.begin(), loop.end());
  }
  return loops;
}

}  // namespace sterna::surfmesh
