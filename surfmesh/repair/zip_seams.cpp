// For each tolerance there are two steps. First, a boundary vertex near the middle of another boundary's edge splits that edge; no vertex moves. Then the
// nearest pairs of boundary vertices are merged at their midpoint, if the boundaries continue beside them in the same way. A pair is refused if merging would
// invert a facet or crowd an edge. It is also refused if its vertices are farther apart than half of their boundary edges, because features are larger than
// gaps.
#include <algorithm>
#include <map>
#include <set>

#include "geom/base/disjoint_sets.h"
#include "geom/base/sort_unique.h"
#include "geom/math/measures.h"
#include "geom/math/nearest.h"
#include "geom/mesh/bvh.h"
#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_first_share = 1e-9;   ///< relative to L: first tolerance
constexpr double k_growth = 4.0;         ///< factor from one tolerance to the next
constexpr int k_tries = 4;               ///< largest number of rounds at one tolerance
constexpr double k_feature_share = 0.5;  ///< relative to the shortest boundary edge: pairs farther apart are no seam
constexpr double k_turn_cosine = 0.5;    ///< a facet that turns by more than 60 degrees would be damaged
constexpr std::uint32_t k_nobody = 0xffffffffu;

struct OpenBorders {
  std::vector<std::uint32_t> halfedges;                ///< half-edges on edges with one facet
  std::vector<std::uint32_t> vertices;                 ///< ascending
  std::vector<std::vector<std::uint32_t>> neighbours;  ///< for each vertex of the surface: its neighbours along open boundaries
  std::vector<double> shortest;                        ///< m, shortest boundary edge at each vertex
};

OpenBorders find_borders(const RepairState& state) {
  OpenBorders borders;
  const EdgeTable table = state.edges();
  borders.neighbours.resize(state.points.size());
  borders.shortest.assign(state.points.size(), 1e300);
  for (const Edge& edge : table.edges()) {
    if (edge.count != 1) continue;
    borders.halfedges.push_back(table.at(edge)[0]);
    borders.vertices.push_back(edge.low);
    borders.vertices.push_back(edge.high);
    borders.neighbours[edge.low].push_back(edge.high);
    borders.neighbours[edge.high].push_back(edge.low);
    const double length = distance(state.points[edge.low], state.points[edge.high]);
    for (const std::uint32_t v : {edge.low, edge.high}) borders.shortest[v] = std::min(borders.shortest[v], length);
  }
  sort_unique(borders.vertices);
  return borders;
}

Box grown(Box box, double by) {
  box.min -= Vec3{by, by, by};
  box.max += Vec3{by, by, by};
  return box;
}

/// Splits boundary edges at vertices of other boundaries. In one round each edge is split at most once, and a facet with several boundary edges is split at one
/// of them. \return number of splits
std::size_t split_at_vertices(RepairState& state, double tolerance, const RunContext& context) {
  const OpenBorders borders = find_borders(state);
  std::vector<Box> boxes;
  for (const std::uint32_t h : borders.halfedges) {
    Box box;
    box.add(state.points[state.facets[h / 3][h % 3]]);
    box.add(state.points[state.facets[h / 3][next_halfedge(h) % 3]]);
    boxes.push_back(grown(box, tolerance));
  }
  const BoxTree tree(boxes, context);
  struct Split {
    double distance = 0.0;
    std::uint32_t halfedge = 0, vertex = 0;
    Vec3 nearest_point;
  };
  std::map<std::uint32_t, Split> best;  // best split by facet
  for (const std::uint32_t a : borders.vertices) {
    const Vec3& p = state.points[a];
    Split nearest{.distance = tolerance, .halfedge = k_nobody, .vertex = a, .nearest_point = {}};
    bool is_at_vertex = false;
    tree.for_each_overlap({p, p}, [&](std::uint32_t i) {
      const std::uint32_t h = borders.halfedges[i];
      const std::uint32_t u = state.facets[h / 3][h % 3], v = state.facets[h / 3][next_halfedge(h) % 3];
      if (u == a || v == a) return true;
      const Vec3 &pu = state.points[u], &pv = state.points[v];
      const Vec3 nearest_point = nearest_on_segment(p, pu, pv);
      const double d = distance(p, nearest_point);
      if (d > nearest.distance) return true;
      const double from_end = std::min(distance(nearest_point, pu), distance(nearest_point, pv));
      if (from_end <= std::max(2.0 * d, k_first_share * state.length)) {
        is_at_vertex = true;
        return true;
      }
      bool goes_along = false;
      for (const std::uint32_t w : borders.neighbours[a])
        goes_along |= w == u || w == v || distance(state.points[w], nearest_on_segment(state.points[w], pu, pv)) <= tolerance ||
                      distance(pu, nearest_on_segment(pu, p, state.points[w])) <= tolerance ||
                      distance(pv, nearest_on_segment(pv, p, state.points[w])) <= tolerance;
      if (goes_along && (d < nearest.distance || nearest.halfedge == k_nobody)) nearest = {d, h, a, nearest_point};
      return true;
    });
    if (nearest.halfedge == k_nobody || is_at_vertex) continue;
    const auto [found, is_new] = best.try_emplace(nearest.halfedge / 3, nearest);
    if (!is_new && nearest.distance < found->second.distance) found->second = nearest;
  }
  for (const auto& [facet, split] : best) {
    const std::uint32_t h = split.halfedge;
    const Facet old = state.facets[facet];
    const std::uint32_t u = old[h % 3], v = old[next_halfedge(h) % 3], w = old[previous_halfedge(h) % 3];
    const auto m = static_cast<std::uint32_t>(state.points.size());
    state.points.push_back(split.nearest_point);
    state.facets[facet] = {u, m, w};
    state.add({m, v, w}, state.info[facet]);
  }
  return best.size();
}

struct Pair {
  double distance = 0.0;
  std::uint32_t a = 0, b = 0;  ///< a < b
};

std::vector<Pair> near_pairs(const RepairState& state, const OpenBorders& borders, double tolerance, const RunContext& context) {
  std::vector<Box> boxes;
  for (const std::uint32_t v : borders.vertices) boxes.push_back(grown({state.points[v], state.points[v]}, 0.51 * tolerance));
  std::vector<std::vector<std::uint32_t>> near(state.points.size());
  std::vector<Pair> pairs;
  for (const auto& [i, j] : BoxTree(boxes, context).overlapping_pairs(context)) {
    const std::uint32_t a = borders.vertices[i], b = borders.vertices[j];
    const double d = distance(state.points[a], state.points[b]);
    if (d > tolerance || d > k_feature_share * std::min(borders.shortest[a], borders.shortest[b])) continue;
    near[a].push_back(b);
    near[b].push_back(a);
    pairs.push_back({d, a, b});
  }
  const auto is_near = [&](std::uint32_t a, std::uint32_t b) { return a == b || std::find(near[a].begin(), near[a].end(), b) != near[a].end(); };
  std::erase_if(pairs, [&](const Pair& pair) {
    for (const std::uint32_t x : borders.neighbours[pair.a])
      for (const std::uint32_t y : borders.neighbours[pair.b])
        if (is_near(x, y)) return false;
    return true;
  });
  std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) { return std::tie(p.distance, p.a, p.b) < std::tie(q.distance, q.a, q.b); });
  std::vector<char> is_taken(state.points.size(), 0);
  std::erase_if(pairs, [&](const Pair& pair) {
    if (is_taken[pair.a] || is_taken[pair.b]) return true;
    is_taken[pair.a] = is_taken[pair.b] = 1;
    return false;
  });
  return pairs;
}

/// Joins the pairs whose merging does no damage. \return the joined pairs
std::vector<Pair> join_pairs(RepairState& state, std::vector<Pair> pairs) {
  const auto count_open = [](const RepairState& of) {
    std::size_t n = 0;
    const EdgeTable table = of.edges();
    for (const Edge& edge : table.edges()) n += edge.count == 1;
    return n;
  };
  std::vector<std::vector<std::uint32_t>> facets_at(state.points.size());
  for (std::uint32_t t = 0; t < state.facets.size(); ++t)
    for (const std::uint32_t v : state.facets[t]) facets_at[v].push_back(t);
  std::set<std::array<std::uint32_t, 2>> crowded_before;
  const EdgeTable before = state.edges();
  for (const Edge& edge : before.edges())
    if (edge.count > 2) crowded_before.insert({edge.low, edge.high});
  const std::size_t n_open = count_open(state);
  while (!pairs.empty()) {
    std::vector<std::uint32_t> pair_of(state.points.size(), k_nobody);
    std::vector<Vec3> points = state.points;
    std::vector<std::uint32_t> target(state.points.size());
    for (std::uint32_t v = 0; v < target.size(); ++v) target[v] = v;
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
      const auto& [d, a, b] = pairs[i];
      pair_of[a] = pair_of[b] = i;
      points[a] = points[b] = 0.5 * (state.points[a] + state.points[b]);
      target[b] = a;
    }
    std::vector<char> is_bad(pairs.size(), 0);
    for (const Pair& pair : pairs) {
      for (const std::uint32_t v : {pair.a, pair.b}) {
        for (const std::uint32_t t : facets_at[v]) {
          const Facet& f = state.facets[t];
          const Vec3 old = area_vector(state.points[f[0]], state.points[f[1]], state.points[f[2]]), now = area_vector(points[f[0]], points[f[1]], points[f[2]]);
          const bool is_spoiled = dot(old, now) < k_turn_cosine * norm(old) * norm(now) || (norm(old) > 0.0 && norm(now) == 0.0);
          if (is_spoiled || target[f[0]] == target[f[1]] || target[f[1]] == target[f[2]] || target[f[2]] == target[f[0]]) is_bad[pair_of[v]] = 1;
        }
      }
    }
    RepairState trial;
    trial.points = points;
    trial.facets = state.facets;
    for (Facet& f : trial.facets)
      for (std::uint32_t& v : f) v = target[v];
    if (std::find(is_bad.begin(), is_bad.end(), 1) == is_bad.end()) {
      const EdgeTable table = trial.edges();
      for (const Edge& edge : table.edges()) {
        if (edge.count <= 2 || crowded_before.count({edge.low, edge.high})) continue;
        for (const std::uint32_t v : {edge.low, edge.high})
          if (pair_of[v] != k_nobody) is_bad[pair_of[v]] = 1;
      }
    }
    if (std::find(is_bad.begin(), is_bad.end(), 1) == is_bad.end()) {
      if (count_open(trial) >= n_open) return {};
      for (const Pair& pair : pairs)
        for (const std::uint32_t v : {pair.a, pair.b})
          for (const std::uint32_t t : facets_at[v]) state.info[t].is_touched = pair.distance > 0.0;
      state.points = std::move(trial.points);
      state.facets = std::move(trial.facets);
      return pairs;
    }
    std::size_t i = 0;
    std::erase_if(pairs, [&](const Pair&) { return is_bad[i++] != 0; });
  }
  return {};
}

/// Records one change for each run of pairs along an open boundary.
void note_seams(RepairState& state, const std::vector<Pair>& pairs, const OpenBorders& borders) {
  std::vector<std::uint32_t> pair_of(borders.neighbours.size(), k_nobody);
  for (std::uint32_t i = 0; i < pairs.size(); ++i) pair_of[pairs[i].a] = pair_of[pairs[i].b] = i;
  DisjointSets seams(pairs.size());
  for (std::uint32_t i = 0; i < pairs.size(); ++i)
    for (const std::uint32_t v : {pairs[i].a, pairs[i].b})
      for (const std::uint32_t w : borders.neighbours[v])
        if (pair_of[w] != k_nobody) seams.join(i, pair_of[w]);
  std::vector<std::vector<std::uint32_t>> facets_of(pairs.size());
  std::vector<double> widest(pairs.size(), 0.0);
  for (std::uint32_t i = 0; i < pairs.size(); ++i) widest[seams.root(i)] = std::max(widest[seams.root(i)], pairs[i].distance);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t)
    for (const std::uint32_t v : state.facets[t])
      if (v < pair_of.size() && pair_of[v] != k_nobody) facets_of[seams.root(pair_of[v])].push_back(t);
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    sort_unique(facets_of[i]);
    state.note(RepairKind::zipped, facets_of[i], widest[i]);
  }
}

}  // namespace

void zip_seams(RepairState& state, const RepairOptions& options, const RunContext& context) {
  const double last = options.gap * state.length;
  for (double tolerance = std::min(last, k_first_share * state.length); tolerance > 0.0; tolerance = std::min(last, k_growth * tolerance)) {
    context.check_stop();
    for (int round = 0; round < k_tries; ++round) {
      const OpenBorders before = find_borders(state);
      if (before.halfedges.empty()) return;
      const RepairState unsplit = state;
      const std::size_t n_split = split_at_vertices(state, tolerance, context);
      const OpenBorders borders = n_split > 0 ? find_borders(state) : before;
      const std::vector<Pair> joined = join_pairs(state, near_pairs(state, borders, tolerance, context));
      if (joined.empty()) {
        state = unsplit;
        break;
      }
      note_seams(state, joined, borders);
    }
    if (tolerance >= last) break;
  }
}

}  // namespace sterna::surfmesh
