// Changes of connectivity without new points.
//
// Edge removal replaces the tetrahedra around an edge by pairs of tetrahedra over the best triangulation of the ring of vertices around it (2-3 for a ring of
// 3, 4-4 for 4, etc.). Multi-face removal is the inverse operation: faces between the same two vertices are replaced by the edge between these vertices. Based
// on: Shewchuk, Two discrete optimization algorithms for the topological improvement of tetrahedral meshes (2002).

#include <algorithm>

#include "geom/tets/ring_fill.h"
#include "volmesh/improve/region.h"

namespace sterna::volmesh {
namespace {

constexpr std::size_t k_max_ring = 10;  ///< largest ring; removing longer rings hardly ever improves the mesh
constexpr int k_max_faces_deep = 4;     ///< largest recursion depth, counted from the first face

}  // namespace

void Region::try_edges_and_faces(std::uint32_t tet, Change& best) {
  const Corners c = tets_[tet].corners;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) try_edge(c[i], c[j], best);
  for (std::size_t i = 0; i < 4; ++i) try_faces(tet, i, best);
}

void Region::try_edge(std::uint32_t a, std::uint32_t b, Change& best) {
  std::array<std::uint32_t, k_max_ring> around{}, from{}, to{};
  std::size_t n = 0;
  for (const std::uint32_t t : incident_[a]) {
    if (!tets::has(tets_[t].corners, b)) continue;
    if (n == k_max_ring) return;
    around[n] = t;
    const auto [x, y] = tets::other_two(tets_[t].corners, a, b);
    from[n] = x;
    to[n++] = y;
  }
  if (n < 3) return;
  compare_with({around.data(), n});
  // The ring in order. At an edge on the border the ring is open.
  std::array<std::uint32_t, k_max_ring> ring{};
  ring[0] = from[0];
  for (std::size_t i = 1; i <= n; ++i) {
    const auto next = std::find(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(n), ring[i - 1]);
    if (next == from.begin() + static_cast<std::ptrdiff_t>(n)) return;
    const std::uint32_t v = to[static_cast<std::size_t>(next - from.begin())];
    if (i == n ? v != ring[0] : v == ring[0]) return;
    if (i < n) ring[i] = v;
  }
  const double limit = cost_before_ - best.drop;
  const auto with_triangle = [&](std::size_t i, std::size_t j, std::size_t k, double sum, double bound) {
    sum += cost(Corners{ring[i], ring[j], ring[k], b});
    return sum < bound ? sum + cost(Corners{ring[j], ring[i], ring[k], a}) : sum;
  };
  tets::RingFill<k_max_ring> fill;
  if (!fill.find(n, limit, with_triangle, [](std::size_t, std::size_t, double sum) { return sum; })) return;
  best = Change{.drop = cost_before_ - fill.cost()};
  best.removed.assign(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(n));
  fill.for_triangles([&](std::size_t i, std::size_t j, std::size_t k) {
    best.added.push_back({ring[i], ring[j], ring[k], b});
    best.added.push_back({ring[j], ring[i], ring[k], a});
  });
}

std::uint32_t Region::across(std::uint32_t tet, const Face& face) const {
  // Above slivers some vertices have hundreds of tetrahedra. Therefore only the shortest of the three lists is searched.
  const std::uint32_t v = std::ranges::min(face, {}, [&](std::uint32_t u) { return incident_[u].size(); });
  for (const std::uint32_t t : incident_[v])
    if (t != tet && std::ranges::all_of(face, [&](std::uint32_t u) { return tets::has(tets_[t].corners, u); })) return t;
  return k_none;
}

void Region::try_faces(std::uint32_t tet, std::size_t corner, Change& best) {
  const Face face = opposite(tets_[tet].corners, corner);
  const std::uint32_t other = across(tet, face);
  if (other == k_none) return;
  const std::uint32_t above = tets_[tet].corners[corner];
  std::uint32_t below = 0;
  for (const std::uint32_t v : tets_[other].corners)
    if (v != face[0] && v != face[1] && v != face[2]) below = v;
  Change change;
  change.removed = {tet, other};
  compare_with(change.removed);
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += extend_faces(face[k], face[(k + 1) % 3], above, below, tet, 0, change);
    if (cost_before_ - sum <= best.drop) return;
  }
  change.drop = cost_before_ - sum;
  best = std::move(change);
}

/// Extends the set of selected faces at their side (u, v), seen counter-clockwise from `above`. Either (u, v) stays a side and gets a new tetrahedron, or the
/// face beyond it is added to the set. Returns the cost minus that of the tetrahedra at the added faces.
double Region::extend_faces(std::uint32_t u, std::uint32_t v, std::uint32_t above, std::uint32_t below, std::uint32_t from_above, int depth,
                            Change& change) const {
  const Corners side{u, v, below, above};
  const double as_side = cost(side);
  if (as_side > 0.0 && depth < k_max_faces_deep) {
    const std::uint32_t next_above = across(from_above, {u, v, above});
    const auto third = [&]() -> std::uint32_t {
      for (const std::uint32_t w : tets_[next_above].corners)
        if (w != u && w != v && w != above) return w;
      return k_none;
    };
    const std::uint32_t w = next_above == k_none ? k_none : third();
    const std::uint32_t next_below = w == k_none || w == below ? k_none : across(next_above, {u, v, w});
    if (next_below != k_none && tets::has(tets_[next_below].corners, below) && std::ranges::find(change.removed, next_above) == change.removed.end()) {
      Change longer = change;
      longer.removed.push_back(next_above);
      longer.removed.push_back(next_below);
      // The face beyond (u, v) is (v, u, w).
      double sum = -tets_[next_above].cost - tets_[next_below].cost;
      sum += extend_faces(u, w, above, below, next_above, depth + 1, longer);
      if (sum < as_side) sum += extend_faces(w, v, above, below, next_above, depth + 1, longer);
      if (sum < as_side) {
        change = std::move(longer);
        return sum;
      }
    }
  }
  change.added.push_back(side);
  return as_side;
}

}  // namespace sterna::volmesh
