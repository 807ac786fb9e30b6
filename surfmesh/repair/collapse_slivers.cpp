#include <algorithm>
#include <set>

#include "geom/base/sort_unique.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_turn_cosine_of_collapse = 0.2;  ///< the normal of a facet with an area may turn by less than 80 degrees
constexpr int k_collapse_rounds = 10;

struct ShortEdge {
  double length = 0.0;
  std::uint32_t from = 0, to = 0;  ///< vertex `from` is merged into vertex `to`
};

/// Returns true if the ends of an inner edge have exactly two common neighbours. Otherwise the collapse would pinch the surface.
bool is_link_clean(const std::vector<std::vector<std::uint32_t>>& facets_at, const std::vector<Facet>& facets, std::uint32_t a, std::uint32_t b) {
  std::vector<std::uint32_t> na, nb, common;
  for (const std::uint32_t t : facets_at[a]) na.insert(na.end(), facets[t].begin(), facets[t].end());
  for (const std::uint32_t t : facets_at[b]) nb.insert(nb.end(), facets[t].begin(), facets[t].end());
  sort_unique(na);
  sort_unique(nb);
  std::set_intersection(na.begin(), na.end(), nb.begin(), nb.end(), std::back_inserter(common));
  return common.size() == 4;  // two common neighbours and the two ends themselves
}

}  // namespace

void collapse_slivers(RepairState& state, const RepairOptions& options, const RunContext& context) {
  const double limit = options.sliver * state.length;
  const bool had_crossings = find_crossings(state.points, state.facets, context).total > 0;
  for (int round = 0; round < k_collapse_rounds; ++round) {
    context.check_stop();
    const EdgeTable edges = state.edges();
    std::vector<char> is_on_cap(state.points.size(), 0);
    std::vector<std::vector<std::uint32_t>> facets_at(state.points.size());
    for (std::uint32_t t = 0; t < state.facets.size(); ++t)
      for (const std::uint32_t v : state.facets[t]) {
        facets_at[v].push_back(t);
        is_on_cap[v] |= static_cast<char>(state.info[t].mark == FacetMark::cap);
      }
    std::vector<ShortEdge> list;
    for (const Edge& edge : edges.edges()) {
      const double length = distance(state.points[edge.low], state.points[edge.high]);
      if (length > limit || edge.count != 2) continue;
      const auto at = edges.at(edge);
      if (!state.info[at[0] / 3].is_touched && !state.info[at[1] / 3].is_touched) continue;
      // The vertex of the input stays, which has the lower number. Vertices in the symmetry plane of a half model stay in the plane.
      const bool is_low_kept = is_on_cap[edge.low] || !is_on_cap[edge.high];
      list.push_back({length, is_low_kept ? edge.high : edge.low, is_low_kept ? edge.low : edge.high});
    }
    std::sort(list.begin(), list.end(),
              [](const ShortEdge& a, const ShortEdge& b) { return std::tie(a.length, a.from, a.to) < std::tie(b.length, b.from, b.to); });
    const RepairState before = state;
    std::vector<char> is_busy(state.points.size(), 0), is_kept(state.facets.size(), 1);
    std::size_t n_done = 0;
    for (const ShortEdge& edge : list) {
      if (is_busy[edge.from] || is_busy[edge.to] || !is_link_clean(facets_at, state.facets, edge.from, edge.to)) continue;
      bool is_harmless = true;
      for (const std::uint32_t t : facets_at[edge.from]) {
        Facet f = state.facets[t];
        if (std::find(f.begin(), f.end(), edge.to) != f.end()) continue;
        const auto c = state.corners(t);
        const Vec3 old = area_vector(c[0], c[1], c[2]);
        std::replace(f.begin(), f.end(), edge.from, edge.to);
        const Vec3 now = area_vector(state.points[f[0]], state.points[f[1]], state.points[f[2]]);
        // The normal of a sliver triangle itself is not reliable.
        const bool has_area = norm(old) > limit * std::max({distance(c[0], c[1]), distance(c[1], c[2]), distance(c[2], c[0])});
        if (norm(now) == 0.0 || (has_area && dot(old, now) < k_turn_cosine_of_collapse * norm(old) * norm(now))) is_harmless = false;
      }
      if (!is_harmless) continue;
      for (const std::uint32_t v : {edge.from, edge.to})
        for (const std::uint32_t t : facets_at[v])
          for (const std::uint32_t w : state.facets[t]) is_busy[w] = 1;
      std::vector<std::uint32_t> concerned = facets_at[edge.from];
      state.note(RepairKind::collapsed, concerned, edge.length);
      for (const std::uint32_t t : concerned) {
        Facet& f = state.facets[t];
        if (std::find(f.begin(), f.end(), edge.to) != f.end()) is_kept[t] = 0;
        else std::replace(f.begin(), f.end(), edge.from, edge.to);
        state.info[t].is_touched = true;
      }
      ++n_done;
    }
    if (n_done == 0) return;
    state.keep(is_kept);
    if (!had_crossings && find_crossings(state.points, state.facets, context).total > 0) {
      state = before;
      return;
    }
  }
}

}  // namespace sterna::surfmesh
