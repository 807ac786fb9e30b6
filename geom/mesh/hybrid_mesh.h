// The volume mesh: prismatic layers stored as columns, explicit cells for the rest, boundary faces with patches.
// Element order is CGNS SIDS: PENTA_6 base triangle's right-hand normal points towards the other triangle; face tables in cell_faces().
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "geom/base/ids.h"
#include "geom/base/vec3.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

enum class CellKind : std::uint8_t { tetrahedron, pyramid, prism, hexahedron };
inline constexpr std::array<int, 4> k_cell_nodes = {4, 5, 6, 8};
constexpr int n_nodes(CellKind kind) { return k_cell_nodes[static_cast<std::size_t>(kind)]; }
std::string_view to_string(CellKind kind);

/// A cell by value: its kind and its nodes in CGNS order.
struct Cell {
  CellKind kind = CellKind::tetrahedron;
  std::array<NodeId, 8> nodes{};
  std::span<const NodeId> span() const { return {nodes.data(), static_cast<std::size_t>(n_nodes(kind))}; }
};

/// A face of a cell: 3 or 4 local node numbers, right-hand normal out of the cell.
struct LocalFace {
  std::array<std::uint8_t, 4> nodes{};
  std::uint8_t size = 3;
};
/// The SIDS face table of a kind: tet 021 013 123 203, pyramid 0321 014 124 234 304, prism 0143 1254 2035 021 345, hex 0321 0154 1265 2376 0473 4567.
std::span<const LocalFace> cell_faces(CellKind kind);

/// Layers as columns. Line k stands on one wall node; its nodes are consecutive: first_node[k] + j, j = 0 (wall) .. n_steps(k) (envelope). A collapsed line has
/// its wall node alone. A column stands over base triangle (a, b, c) of lines. Where a line has ended, its last node stands for all that would follow: a cell
/// is a prism where no line has ended below it, a pyramid where one has, a tetrahedron where two have; where all have, there is none. So columns that share
/// two lines agree about the faces between them, and the envelope is made of triangles. Lines of a column that are not collapsed differ by one layer at most.
struct LayerBlock {
  int n_layers = 0;                                ///< of every line; the largest where lines differ
  std::vector<std::uint16_t> line_layers;          ///< per line, at least 1; empty: n_layers everywhere
  std::vector<std::array<std::uint32_t, 3>> base;  ///< lines of each base triangle, normal into the fluid
  std::vector<std::uint32_t> first_node;           ///< wall node of each line
  std::vector<std::uint8_t> is_collapsed;          ///< per line

  std::size_t n_lines() const { return first_node.size(); }
  std::size_t n_columns() const { return base.size(); }
  bool is_uniform() const { return line_layers.empty(); }
  /// Layers of a line; of one that is collapsed, what it would have.
  int layers_of_line(std::size_t line) const { return line_layers.empty() ? n_layers : line_layers[line]; }
  /// Cells along a line: none where it is collapsed.
  int n_steps(std::size_t line) const { return is_collapsed[line] ? 0 : layers_of_line(line); }
  /// Last node of a line: on the envelope, or the wall node where it is collapsed.
  NodeId top(std::uint32_t line) const { return NodeId(first_node[line] + static_cast<std::uint32_t>(n_steps(line))); }
  /// Node of layer j (0 = wall) on line k; the last one beyond its end.
  NodeId node(std::uint32_t line, int j) const { return NodeId(first_node[line] + static_cast<std::uint32_t>(std::min(j, n_steps(line)))); }
  int n_collapsed(std::size_t column) const {
    const auto& b = base[column];
    return is_collapsed[b[0]] + is_collapsed[b[1]] + is_collapsed[b[2]];
  }
  /// Where the lines of a column end, ascending: its cells are prisms in layers below the first, pyramids from there to the second, tetrahedra to the third.
  std::array<int, 3> ends_of_column(std::size_t column) const {
    std::array<int, 3> ends = {n_steps(base[column][0]), n_steps(base[column][1]), n_steps(base[column][2])};
    std::sort(ends.begin(), ends.end());
    return ends;
  }
  /// Layers of cells: those of its longest line.
  int layers_of_column(std::size_t column) const {
    const auto& b = base[column];
    return std::max({n_steps(b[0]), n_steps(b[1]), n_steps(b[2])});
  }
  /// Whether it has cells, and all of them are prisms.
  bool is_prismatic(std::size_t column) const {
    const auto& b = base[column];
    const int n = n_steps(b[0]);
    return n > 0 && n == n_steps(b[1]) && n == n_steps(b[2]);
  }
  /// Kind of the cell in a layer. \pre layer < layers_of_column(column)
  CellKind kind(std::size_t column, int layer) const {
    const auto& b = base[column];
    const int n_ended = (n_steps(b[0]) <= layer) + (n_steps(b[1]) <= layer) + (n_steps(b[2]) <= layer);
    return n_ended == 0 ? CellKind::prism : n_ended == 1 ? CellKind::pyramid : CellKind::tetrahedron;
  }
  /// Layers [begin, end) of a column in which its cells are of a kind.
  std::array<int, 2> layers_of_kind(std::size_t column, CellKind of) const {
    const std::array<int, 3> ends = ends_of_column(column);
    switch (of) {
      case CellKind::prism: return {0, ends[0]};
      case CellKind::pyramid: return {ends[0], ends[1]};
      case CellKind::tetrahedron: return {ends[1], ends[2]};
      case CellKind::hexahedron: break;
    }
    return {0, 0};
  }
  /// Cell `layer` (0 = at the wall) of a column.
  /// \pre layer < layers_of_column(column)
  Cell cell(std::size_t column, int layer) const;
  /// The side between the lines of corners `corner` and the next in a layer, normal out of the column: four nodes, three where one of the lines has ended, none
  /// where both have.
  struct Side {
    std::array<NodeId, 4> nodes{};
    std::uint8_t size = 0;
  };
  Side side(std::size_t column, std::size_t corner, int layer) const;
};

/// What was asked of the layer: its first height, growth and coverage are measured against it. Unknown for a mesh that was read from a file.
struct LayerRequest {
  double first_height = 0.0;              ///< m; 0 = nothing is known; the smallest where lines differ
  double max_growth = 0.0;                ///< largest ratio of heights of consecutive cells; the largest where lines differ
  std::vector<double> line_first_height;  ///< m, along the vertex's normal, per line; empty: first_height everywhere
  std::vector<double> line_first_room;  ///< m, least height of the whole line with which its first height is met to 2 %, per line; empty: layers x first height
  std::vector<double> line_boundary_layer;  ///< m, thickness of the boundary layer that the line has to cover; 0: none is asked for; empty: of no line
  std::vector<double> line_max_growth;      ///< per line; empty: max_growth everywhere
  std::vector<std::uint16_t> line_layers;   ///< per line; empty: as many as it has, so that none was truncated
  std::vector<double> target_height;        ///< m, of the whole layer, per line
  std::vector<std::uint8_t> reason;         ///< per line: why it is lower than its target, index of `reasons`
  std::vector<std::string> reasons;         ///< for people
  bool is_known() const { return first_height > 0.0; }
  /// m, of a line with n layers
  double first_room_of(std::size_t line, int n) const { return line_first_room.empty() ? n * first_height_of(line) : line_first_room[line]; }
  double first_height_of(std::size_t line) const { return line_first_height.empty() ? first_height : line_first_height[line]; }
};

/// The columns by line (for_each_column); a new member does not compile until it is here.
template <class Request>
requires std::is_same_v<std::remove_const_t<Request>, LayerRequest>
auto columns_of(Request& request) {
  auto& [first_height, max_growth, line_first_height, line_first_room, line_boundary_layer, line_max_growth, line_layers, target_height, reason, reasons] =
      request;
  return std::tie(line_first_height, line_first_room, line_boundary_layer, line_max_growth, line_layers, target_height, reason);
}

struct BoundaryTriangle {
  std::array<NodeId, 3> nodes;  ///< right-hand normal out of the fluid
  PatchId patch;
};
struct BoundaryQuad {
  std::array<NodeId, 4> nodes;  ///< right-hand normal out of the fluid
  PatchId patch;
};

struct CellCounts {
  std::int64_t tetrahedra = 0;
  std::int64_t pyramids = 0;
  std::int64_t prisms = 0;
  std::int64_t hexahedra = 0;
  std::int64_t total() const { return tetrahedra + pyramids + prisms + hexahedra; }
};

/// Two patches of which the second is the first, moved: flow that leaves through one comes in through the other. Node by node and face by face
/// (geom/mesh/periodic.h).
struct PeriodicSides {
  PatchId first, second;
  Vec3 translation;  ///< m, from the first to the second
};

/// Plain struct of columns. Cells come in this order: those of `layers`, column by column, layer by layer; then prisms, pyramids,
/// hexahedra, tetrahedra. A mesh read from a file has its cells in the explicit arrays and no layers.
struct HybridMesh {
  Column<NodeId, Point> points;  ///< metres
  LayerBlock layers;
  LayerRequest request;  ///< of `layers`
  std::vector<std::array<NodeId, 6>> prisms;
  std::vector<std::array<NodeId, 5>> pyramids;
  std::vector<std::array<NodeId, 8>> hexahedra;
  std::vector<std::array<NodeId, 4>> tetrahedra;
  std::vector<BoundaryTriangle> boundary_triangles;
  std::vector<BoundaryQuad> boundary_quads;
  Column<PatchId, Patch> patches;
  std::vector<PeriodicSides> periodic;
};

CellCounts count_cells(const HybridMesh& mesh);

/// The same mesh with the cells of its columns moved to the explicit arrays (order kept); for tests and converters.
HybridMesh explicit_cells(HybridMesh mesh);

/// Calls f(const Cell&) for every cell in file order.
template <class F>
void for_each_cell(const HybridMesh& mesh, const F& f) {
  for (std::size_t c = 0; c < mesh.layers.n_columns(); ++c) {
    for (int j = 0, n = mesh.layers.layers_of_column(c); j < n; ++j) f(mesh.layers.cell(c, j));
  }
  const auto explicit_block = [&](CellKind kind, const auto& cells) {
    Cell cell;
    cell.kind = kind;
    for (const auto& nodes : cells) {
      std::copy(nodes.begin(), nodes.end(), cell.nodes.begin());
      f(cell);
    }
  };
  explicit_block(CellKind::prism, mesh.prisms);
  explicit_block(CellKind::pyramid, mesh.pyramids);
  explicit_block(CellKind::hexahedron, mesh.hexahedra);
  explicit_block(CellKind::tetrahedron, mesh.tetrahedra);
}

}  // namespace sterna
