// Sizes carried over a surface. A small size grows with the distance along the surface and never crosses a gap.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::surfmesh {

/// Locations on a surface, joined by cells. All nodes of a cell are neighbours. A node may belong to many cells.
struct SizeGraph {
  std::vector<Point> points;
  std::vector<std::array<Vec3, 2>> normals;  ///< unit normals, two where two faces meet; zero: sizes pass in any direction
  std::vector<double> sizes;                 ///< m: required size of each node; after carry_sizes the final size
  std::vector<std::uint8_t> is_passing;      ///< zero: the node receives a size but passes none on (it lies outside a face's border)
  std::vector<std::uint32_t> cell_ends;      ///< nodes of cell c: cell_nodes[c == 0 ? 0 : cell_ends[c - 1]] up to cell_ends[c]
  std::vector<std::uint32_t> cell_nodes;

  std::uint32_t add_node(const Point& point, const std::array<Vec3, 2>& sides, double size, bool passes);
  void close_cell() { cell_ends.push_back(static_cast<std::uint32_t>(cell_nodes.size())); }
};

/// Lowers sizes to the minimum over nodes y of (size of y + growth * distance along the surface). Nodes are processed in ascending order of sizes (Dijkstra).
/// Each node stores the location its size comes from. Its neighbours measure the straight distance from that location while the surface in between is nearly
/// plane (the vector distances of Danielsson 1980), so distances have no grid error. Where the surface turns away, or the path bends around a border, the node
/// itself is the new origin. Serial, O(n log n), deterministic.
void carry_sizes(SizeGraph& graph, double growth);

}  // namespace sterna::surfmesh
