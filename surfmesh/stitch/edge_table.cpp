#include "surfmesh/stitch/edge_table.h"

#include <algorithm>
#include <numeric>

#include "geom/base/disjoint_sets.h"
#include "geom/base/ids.h"

namespace sterna::surfmesh {

EdgeTable::EdgeTable(const std::vector<Facet>& facets, std::size_t n_points) {
  const std::size_t n = 3 * facets.size();
  if (n >= HalfedgeId::k_invalid) throw_id_overflow(n);
  // Counting sort by the lower vertex. The few half-edges at one vertex are then sorted by (higher vertex, half-edge).
  struct Entry {
    std::uint32_t high, halfedge;
    bool operator<(const Entry& b) const { return high != b.high ? high < b.high : halfedge < b.halfedge; }
  };
  std::vector<std::uint32_t> first(n_points + 1, 0);
  const auto ends = [&](std::uint32_t h) {
    const Facet& facet = facets[h / 3];
    return std::minmax(facet[h % 3], facet[next_halfedge(h) % 3]);
  };
  for (std::uint32_t h = 0; h < n; ++h) ++first[std::size_t{ends(h).first} + 1];
  for (std::size_t v = 0; v < n_points; ++v) first[v + 1] += first[v];
  std::vector<Entry> entries(n);
  std::vector<std::uint32_t> cursor(first.begin(), first.end() - 1);
  for (std::uint32_t h = 0; h < n; ++h) {
    const auto [low, high] = ends(h);
    entries[cursor[low]++] = {high, h};
  }
  halfedges_.resize(n);
  halfedge2edge_.resize(n);
  edges_.reserve(n / 2 + 1);
  for (std::uint32_t v = 0; v < n_points; ++v) {
    std::sort(entries.begin() + first[v], entries.begin() + first[v + 1]);
    for (std::uint32_t i = first[v]; i < first[v + 1]; ++i) {
      if (i == first[v] || entries[i].high != entries[i - 1].high) edges_.push_back({v, entries[i].high, i, 0});
      ++edges_.back().count;
      halfedges_[i] = entries[i].halfedge;
      halfedge2edge_[entries[i].halfedge] = static_cast<std::uint32_t>(edges_.size() - 1);
    }
  }
}

Parts connected_parts(std::size_t n_facets, const EdgeTable& edges) {
  DisjointSets sets(n_facets);
  for (const Edge& edge : edges.edges())
    for (const std::uint32_t h : edges.at(edge).subspan(1)) sets.join(edges.at(edge)[0] / 3, h / 3);
  Parts parts;
  parts.part.resize(n_facets);
  for (std::uint32_t i = 0; i < n_facets; ++i) {
    const std::uint32_t root = sets.root(i);  // the root is the lowest facet of the part, so it already has a number
    parts.part[i] = root == i ? parts.count++ : parts.part[root];
  }
  return parts;
}

Defects find_defects(const std::vector<Facet>& facets, std::size_t n_points, const EdgeTable& edges) {
  Defects defects;
  DisjointSets corners(3 * facets.size());
  const auto corner_at = [&](std::uint32_t h, std::uint32_t vertex) { return facets[h / 3][h % 3] == vertex ? h : next_halfedge(h); };
  for (const Edge& edge : edges.edges()) {
    if (edge.count == 1) defects.boundary.push_back(edge);
    if (edge.count > 2) defects.crowded.push_back(edge);
    const auto halfedges = edges.at(edge);
    for (const std::uint32_t h : halfedges.subspan(1)) {
      corners.join(corner_at(halfedges[0], edge.low), corner_at(h, edge.low));
      corners.join(corner_at(halfedges[0], edge.high), corner_at(h, edge.high));
    }
  }
  std::vector<std::uint32_t> n_fans(n_points, 0);
  for (std::uint32_t c = 0; c < 3 * facets.size(); ++c)
    if (corners.root(c) == c) ++n_fans[facets[c / 3][c % 3]];
  for (std::uint32_t v = 0; v < n_points; ++v)
    if (n_fans[v] > 1) defects.pinched.push_back(v);
  return defects;
}

}  // namespace sterna::surfmesh
