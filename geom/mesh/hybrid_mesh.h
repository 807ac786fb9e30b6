// The volume mesh: prismatic layers stored as columns, explicit cells for the rest, boundary faces with patches.
// Elements are ordered as in CGNS SIDS: the right-hand normal of the base triangle of a PENTA_6 points towards the other triangle. The face tables are in
// cell_faces().
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
/// Returns the SIDS face table of a kind: tet 021 013 123 203, pyramid 0321 014 124 234 304, prism 0143 1254 2035 021 345, hex 0321 0154 1265 2376 0473 4567.
std::span<const LocalFace> cell_faces(CellKind kind);

/// Layers as columns. Growth line k stands on one wall node; its nodes are consecutive: first_node[k] + j, j = 0 (wall) .. n_steps(k) (envelope). A collapsed
/// line consists of its wall node only. A column stands over base triangle (a, b, c) of lines. Above the end of a line, its last node replaces all further
/// nodes. A cell is a prism if no line has ended below it, a pyramid if one has, a tetrahedron if two have; there is no cell if all have ended. Columns that
/// share two lines therefore agree about the faces between them, and the envelope consists of triangles. Lines of a column that are not collapsed differ by
/// at most one layer.
struct LayerBlock {
  int n_layers = 0;                                ///< layers of every line; the largest number if lines differ
  std::vector<std::uint16_t> line_layers;          ///< per line, at least 1; empty: n_layers everywhere
  std::vector<std::array<std::uint32_t, 3>> base;  ///< lines of each base triangle, normal into the fluid
  std::vector<std::uint32_t> first_node;           ///< wall node of each line
  std::vector<std::uint8_t> is_collapsed;          ///< per line

  std::size_t n_lines() const { return first_node.size(); }
  std::size_t n_columns() const { return base.size(); }
  bool is_uniform() const { return line_layers.empty(); }
  /// Returns the number of layers of a line; for a collapsed line, the number that it would have.
  int layers_of_line(std::size_t line) const { return line_layers.empty() ? n_layers : line_layers[line]; }
  /// Returns the number of cells along a line: 0 if the line is collapsed.
  int n_steps(std::size_t line) const { return is_collapsed[line] ? 0 : layers_of_line(line); }
  /// Returns the last node of a line: on the envelope, or the wall node if the line is collapsed.
  NodeId top(std::uint32_t line) const { return NodeId(first_node[line] + static_cast<std::uint32_t>(n_steps(line))); }
  /// Returns the node of layer j (0 = wall) on line k; above the end of the line, its last node.
  NodeId node(std::uint32_t line, int j) const { return NodeId(first_node[line] + static_cast<std::uint32_t>(std::min(j, n_steps(line)))); }
  int n_collapsed(std::size_t column) const {
    const auto& b = base[column];
    return is_collapsed[b[0]] + is_collapsed[b[1]] + is_collapsed[b[2]];
  }
  /// Returns the layers in which the lines of a column end, ascending. Cells are prisms in layers below the first value, pyramids from there to the second,
  /// tetrahedra to the third.
  std::array<int, 3> ends_of_column(std::size_t column) const {
    std::array<int, 3> ends = {n_steps(base[column][0]), n_steps(base[column][1]), n_steps(base[column][2])};
    std::sort(ends.begin(), ends.end());
    return ends;
  }
  /// Returns the number of layers of cells: that of the column's longest line.
  int layers_of_column(std::size_t column) const {
    const auto& b = base[column];
    return std::max({n_steps(b[0]), n_steps(b[1]), n_steps(b[2])});
  }
  /// Returns true if the column has cells and all of them are prisms.
  bool is_prismatic(std::size_t column) const {
    const auto& b = base[column];
    const int n = n_steps(b[0]);
    return n > 0 && n == n_steps(b[1]) && n == n_steps(b[2]);
  }
  /// Returns the kind of the cell in a layer. \pre layer < layers_of_column(column)
  CellKind kind(std::size_t column, int layer) const {
    const auto& b = base[column];
    const int n_ended = (n_steps(b[0]) <= layer) + (n_steps(b[1]) <= layer) + (n_steps(b[2]) <= layer);
    return n_ended == 0 ? CellKind::prism : n_ended == 1 ? CellKind::pyramid : CellKind::tetrahedron;
  }
  /// Returns the layers [begin, end) of a column in which its cells have this kind.
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
  /// Returns cell `layer` (0 = at the wall) of a column.
  /// \pre layer < layers_of_column(column)
  Cell cell(std::size_t column, int layer) const;
  /// A side of a column in one layer, between the lines of corner `corner` and of the next corner, normal out of the column. It has four nodes, three if one of
  /// the lines has ended, none if both have ended.
  struct Side {
    std::array<NodeId, 4> nodes{};
    std::uint8_t size = 0;
  };
  Side side(std::size_t column, std::size_t corner, int layer) const;
};

/// The requested layer, with which the measured first height, growth and coverage are compared. It is unknown for a mesh that was read from a file.
struct LayerRequest {
  double first_height = 0.0;                ///< m; 0 = unknown; the smallest of all lines if they differ
  double max_growth = 0.0;                  ///< largest ratio of heights of consecutive cells; the largest of all lines if they differ
  std::vector<double> line_first_height;    ///< m, along the vertex normal, per line; empty: first_height everywhere
  std::vector<double> line_first_room;      ///< m, smallest line height at which the line's first height is met to 2 %, per line; empty: layers x first height
  std::vector<double> line_boundary_layer;  ///< m, boundary-layer thickness that the line must cover; 0: not requested; empty: not requested for any line
  std::vector<double> line_max_growth;      ///< per line; empty: max_growth everywhere
  std::vector<std::uint16_t> line_layers;   ///< per line; empty: as many as the line has, so that no line was truncated
  std::vector<double> target_height;        ///< m, of the whole layer, per line
  std::vector<std::uint8_t> reason;         ///< per line: why its height is below the target, index into `reasons`
  std::vector<std::string> reasons;         ///< human-readable
  bool is_known() const { return first_height > 0.0; }
  /// Returns the smallest height in m at which a line with n layers meets its first height (see line_first_room).
  double first_room_of(std::size_t line, int n) const { return line_first_room.empty() ? n * first_height_of(line) : line_first_room[line]; }
  double first_height_of(std::size_t line) const { return line_first_height.empty() ? first_height : line_first_height[line]; }
  double max_growth_of(std::size_t line) const { return line_max_growth.empty() ? max_growth : line_max_growth[line]; }
};

/// Returns the columns by line (for_each_column). A new member of LayerRequest does not compile until it is added here.
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

/// Two periodic patches; the second is a translated copy of the first. Flow that leaves through one patch enters through the other. They match node by node
/// and face by face (geom/mesh/periodic.h).
struct PeriodicSides {
  PatchId first, second;
  Vec3 translation;  ///< m, from the first to the second
};

/// Volume mesh as a plain struct of columns. Cells are ordered: cells of `layers`, column by column, layer by layer; then prisms, pyramids, hexahedra,
/// tetrahedra. A mesh read from a file has its cells in the explicit arrays and no layers.
struct HybridMesh {
  Column<NodeId, Point> points;  ///< metres
  LayerBlock layers;
  LayerRequest request;  ///< request for `layers`
  std::vector<std::array<NodeId, 6>> prisms;
  std::vector<std::array<NodeId, 5>> pyramids;
  std::vector<std::array<NodeId, 8>> hexahedra;
  std::vector<std::array<NodeId, 4>> tetrahedra;
  std::vector<BoundaryTriangle> boundary_triangles;
  std::vector<BoundaryQuad> boundary_quads;
  Column<PatchId, Patch> patches;
  std::vector<PeriodicSides> periodic;
  std::int64_t n_flipped_cells = 0;  ///< cells that were inverted in the file and were flipped by its reader
};

CellCounts count_cells(const HybridMesh& mesh);

/// Returns the same mesh with the cells of its columns moved to the explicit arrays (order kept); for tests and converters.
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
