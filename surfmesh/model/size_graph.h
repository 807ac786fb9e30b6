// Sizes carried over a surface: a small size grows with the distance along the surface and never crosses a gap.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::surfmesh {

/// Locations on a surface, joined by cells: all nodes of a cell are neighbours. A node may be in many cells.
struct SizeGraph {
  std::vector<Point> points;
  std::vector<std::array<Vec3, 2>> normals;  ///< unit; of both faces where two meet; zero: sizes pass in any direction
  std::vector<double> sizes;                 ///< m: required size of each node; the final size after carry_sizes
  std::vector<std::uint8_t> is_passing;      ///< zero: receives a size and passes none on (outside a face's border)
  std::vector<std::uint32_t> cell_ends;      ///< nodes of cell c: cell_nodes[c == 0 ? 0 : cell_ends[c - 1]] up to cell_ends[c]
  std::vector<std::uint32_t> cell_nodes;

  std::uint32_t add_node(const Point& point, const std::array<Vec3, 2>& sides, double size, bool passes);
  void close_cell() { cell_ends.push_back(static_cast<std::uint32_t>(cell_nodes.size())); }
};

/// Lowers sizes to min over nodes y of (size of y + growth * distance along the surface), in the order of sizes (Dijkstra). Each node keeps the location its
/// size comes from, and its neighbours measure straight from there as long as the surface is plain between (the vector distances of Danielsson 1980), so
/// distances have no grid error. Where the surface turns away, or the path bends around a border, the node itself is the new origin. Serial, n log n,
/// deterministic.
void carry_sizes(SizeGraph& graph, double growth);

}  // namespace sterna::surfmesh
