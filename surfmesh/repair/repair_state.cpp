#include "surfmesh/repair/repair_state.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "geom/base/disjoint_sets.h"
#include "geom/math/measures.h"
#include "surfmesh/stitch/clean_facets.h"
#include "surfmesh/stitch/orient.h"

namespace sterna::surfmesh {
namespace {

constexpr std::size_t k_max_drawn = 400000;  ///< largest number of facets in a drawing of changes

Box box_of(const RepairState& state, const std::vector<std::uint32_t>& facets) {
  Box box;
  for (const std::uint32_t t : facets)
    for (const Vec3& p : state.corners(t)) box.add(p);
  return box;
}

}  // namespace

void RepairState::keep(const std::vector<char>& is_kept) {
  std::size_t n = 0;
  for (std::size_t t = 0; t < facets.size(); ++t) {
    if (!is_kept[t]) continue;
    facets[n] = facets[t];
    info[n++] = info[t];
  }
  facets.resize(n);
  info.resize(n);
}

void RepairState::add(const Facet& facet, const FacetInfo& of) {
  facets.push_back(facet);
  info.push_back(of);
}

void RepairState::note(RepairKind kind, const std::vector<std::uint32_t>& of, double size) {
  if (of.empty()) return;
  const Box box = box_of(*this, of);
  const auto number = static_cast<std::uint32_t>(report.changes.size());
  report.changes.push_back({kind, box.center(), size < 0.0 ? norm(box.max - box.min) : size, static_cast<std::int64_t>(of.size())});
  RepairDrawing& drawing = report.drawing;
  for (const std::uint32_t t : of) {
    if (drawing.triangles.size() >= k_max_drawn) return;
    const auto first = static_cast<std::uint32_t>(drawing.points.size());
    for (const Vec3& p : corners(t)) drawing.points.push_back(p);
    drawing.triangles.push_back({first, first + 1, first + 2});
    drawing.change.push_back(number);
  }
}

void RepairState::note_parts(RepairKind kind, const std::vector<char>& is_of, const EdgeTable& edges) {
  DisjointSets sets(facets.size());
  for (const Edge& edge : edges.edges()) {
    std::uint32_t first = k_none;
    for (const std::uint32_t h : edges.at(edge)) {
      if (!is_of[h / 3]) continue;
      if (first == k_none) first = h / 3;
      else sets.join(first, h / 3);
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> parts;
  for (std::uint32_t t = 0; t < facets.size(); ++t)
    if (is_of[t]) parts[sets.root(t)].push_back(t);
  for (const auto& [first, part] : parts) note(kind, part);
}

void weld_rounded(RepairState& state, bool is_oriented) {
  std::vector<std::uint32_t> order(state.points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) { return std::array{state.points[v].x, state.points[v].y, state.points[v].z}; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  std::vector<std::uint32_t> representative(state.points.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    representative[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? representative[order[i - 1]] : order[i];
  std::vector<char> is_kept(state.facets.size(), 1);
  std::vector<std::pair<Facet, std::uint32_t>> sorted;
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    Facet& facet = state.facets[t];
    for (std::uint32_t& v : facet) v = representative[v];
    if (facet[0] == facet[1] || facet[1] == facet[2] || facet[2] == facet[0]) {
      is_kept[t] = 0;
      continue;
    }
    const auto c = state.corners(t);
    if (is_collinear(c[0], c[1], c[2])) {
      is_kept[t] = 0;
      continue;
    }
    Facet key_of = facet;
    std::sort(key_of.begin(), key_of.end());
    sorted.emplace_back(key_of, t);
  }
  std::sort(sorted.begin(), sorted.end());
  const auto is_even = [](const Facet& f) { return (f[0] < f[1]) + (f[1] < f[2]) + (f[2] < f[0]) == 2; };  // one of the two orientations
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    bool is_cap = false;
    std::int64_t balance = 0;
    for (end = begin; end < sorted.size() && sorted[end].first == sorted[begin].first; ++end) {
      const std::uint32_t t = sorted[end].second;
      is_cap |= state.info[t].mark == FacetMark::cap;
      balance += is_even(state.facets[t]) ? 1 : -1;
      if (end > begin) is_kept[t] = 0;
    }
    if (end - begin < 2) continue;
    // A facet that coincides with the cap is not part of the result.
    if (is_cap) state.info[sorted[begin].second].mark = FacetMark::cap;
    if (is_oriented && balance == 0) is_kept[sorted[begin].second] = 0;
  }
  state.keep(is_kept);
}

void drop_small_parts(RepairState& state, const RepairOptions& options) {
  const EdgeTable edges = state.edges();
  const Parts parts = connected_parts(state.facets.size(), edges);
  if (parts.count < 2) return;
  std::vector<Box> box(parts.count);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t)
    for (const Vec3& p : state.corners(t)) box[parts.part[t]].add(p);
  std::vector<char> is_dropped(state.facets.size(), 0), is_kept(state.facets.size(), 1);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    const Box& of = box[parts.part[t]];
    if (norm(of.max - of.min) >= options.smallest_part * state.length) continue;
    is_dropped[t] = 1;
    is_kept[t] = 0;
  }
  if (std::find(is_kept.begin(), is_kept.end(), 1) == is_kept.end()) return;
  state.note_parts(RepairKind::removed_part, is_dropped, edges);
  state.keep(is_kept);
}

void drop_flat_parts(RepairState& state) {
  const EdgeTable edges = state.edges();
  const ThinParts thin = find_thin_parts(state.points, state.facets, edges, state.length);
  if (thin.count == 0) return;
  state.note_parts(RepairKind::removed_part, thin.is_thin, edges);
  std::vector<char> is_kept;
  for (const char is_thin : thin.is_thin) is_kept.push_back(static_cast<char>(is_thin == 0));
  state.keep(is_kept);
}

void make_consistent(RepairState& state) {
  const EdgeTable edges = state.edges();
  WorkingSurface surface;
  surface.points = state.points;
  surface.facets = state.facets;
  const Orientation orientation = flood_orientation(surface, edges);
  std::vector<std::int64_t> balance(orientation.n_components, 0);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) balance[orientation.component[t]] += orientation.is_flipped[t] ? -1 : 1;
  std::vector<char> is_turned(state.facets.size(), 0);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    if (static_cast<bool>(orientation.is_flipped[t]) != (balance[orientation.component[t]] >= 0)) continue;
    is_turned[t] = 1;
    std::swap(state.facets[t][1], state.facets[t][2]);
  }
  state.note_parts(RepairKind::turned, is_turned, edges);
}

}  // namespace sterna::surfmesh
