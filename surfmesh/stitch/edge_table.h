// Private to surfmesh/stitch: the edges of a facet set with all facets at each edge (any number), and the defects that follow from the numbers of facets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// A half-edge is 3 * facet + corner and runs from that corner's vertex to the next corner's.
inline std::uint32_t next_halfedge(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline std::uint32_t previous_halfedge(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

struct Edge {
  std::uint32_t low = 0, high = 0;     ///< vertices, low < high
  std::uint32_t first = 0, count = 0;  ///< range in EdgeTable::halfedges
};

/// \pre no facet has a repeated vertex.
class EdgeTable {
 public:
  EdgeTable(const std::vector<Facet>& facets, std::size_t n_points);

  std::span<const Edge> edges() const { return edges_; }
  /// Returns the half-edges along an edge, in ascending order.
  std::span<const std::uint32_t> at(const Edge& edge) const { return {halfedges_.data() + edge.first, edge.count}; }
  const Edge& edge_of(std::uint32_t halfedge) const { return edges_[halfedge2edge_[halfedge]]; }

 private:
  std::vector<Edge> edges_;  ///< sorted by ascending (low, high)
  std::vector<std::uint32_t> halfedges_;
  std::vector<std::uint32_t> halfedge2edge_;
};

/// Part number of each facet. Parts are connected across shared edges with any number of facets, and are numbered in the order of their first facets.
struct Parts {
  std::vector<std::uint32_t> part;  ///< part of each facet
  std::uint32_t count = 0;
};
Parts connected_parts(std::size_t n_facets, const EdgeTable& edges);

struct Defects {
  std::vector<Edge> boundary;          ///< edges with one facet
  std::vector<Edge> crowded;           ///< edges with more than two facets
  std::vector<std::uint32_t> pinched;  ///< vertices with more than one fan of facets (facets of a fan are connected through any shared edges)
};
Defects find_defects(const std::vector<Facet>& facets, std::size_t n_points, const EdgeTable& edges);

}  // namespace sterna::surfmesh
