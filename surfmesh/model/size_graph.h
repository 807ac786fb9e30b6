// Sizes carried over a surface: what a fine place asks for, growing with the distance along the surface and never across a gap.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna::surfmesh {

/// Places of a surface, joined by cells: all nodes of a cell see each other. A node may be in many cells.
struct SizeGraph {
  std::vector<Point> points;
  std::vector<std::array<Vec3, 2>> normals;  ///< unit; of both faces where two meet; zero: any direction leads on
  std::vector<double> sizes;                 ///< m: what each place asks for; after carry_sizes what it gets
  std::vector<std::uint8_t> is_passing;      ///< zero: takes a size and hands none on (outside a face's border)
  std::vector<std::uint32_t> cell_ends;      ///< nodes of cell c: cell_nodes[c == 0 ? 0 : cell_ends[c - 1]] up to cell_ends[c]
  std::vector<std::uint32_t> cell_nodes;

  std::uint32_t add_node(const Point& point, const std::array<Vec3, 2>& sides, double size, bool passes);
  void close_cell() { cell_ends.push_back(static_cast<std::uint32_t>(cell_nodes.size())); }
};

/// Lowers sizes to min over nodes y of (size of y + growth * distance along the surface), in the order of sizes (Dijkstra). Each node keeps the place its size
/// comes from, and its neighbours measure straight from there as long as the surface is plain between (the vector distances of Danielsson 1980), so distances
/// have no error of the grid; where the surface turns away, or the way bends around a border, the node itself is the new origin. Serial, n log n, the same
/// result always.
void carry_sizes(SizeGraph& graph, double growth);

}  // namespace sterna::surfmesh
