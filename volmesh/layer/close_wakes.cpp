// Steps: number_nodes; keep_columns (and make the cells of all other columns); keep_faces; reorder_boundary of the tetrahedra; check the explicit cells.
#include "volmesh/layer/close_wakes.h"

#include <algorithm>
#include <array>
#include <string>

#include "geom/base/columns.h"
#include "geom/base/error.h"
#include "volmesh/layer/explicit_cells.h"
#include "volmesh/layer/renumbered_lines.h"

namespace sterna::volmesh {
namespace {

class WakeCloser {
 public:
  WakeCloser(const DoubledSheets& sheets, HybridMesh& mesh, FillBoundary& boundary)
      : sheets_(sheets), mesh_(mesh), boundary_(boundary), given_(mesh.layers), base_line_(mesh.layers.n_lines()), cells_(mesh) {
    for (std::size_t line = 0; line < base_line_.size(); ++line) base_line_[line] = static_cast<Line>(line);
    for (const DoubledSheets::BaseVertex& base_vertex : sheets.base_vertices) base_line_[base_vertex.sides[1].index()] = base_vertex.sides[0].value();
  }

  void close() {
    number_nodes();
    keep_columns();
    keep_faces();
    reorder_boundary();
    prove();
  }

 private:
  using Line = ExplicitCells::Line;
  bool is_added(Line line) const { return line >= sheets_.n_given_vertices; }
  bool has_own_base(Line line) const { return base_line_[line] == line; }

  NodeId node(Line line, int j) const {
    const int at = std::min(j, given_.n_steps(line));
    if (at == 0) return NodeId(lines_.first(base_line_[line]));
    return NodeId(lines_.first(line) + static_cast<std::uint32_t>(has_own_base(line) ? at : at - 1));
  }

  auto node_of() const {
    return [this](Line line, int j) { return node(line, j); };
  }

  void number_nodes() {
    lines_.renumber(mesh_, [&](Line line, auto begin, std::vector<Point>& points) {
      points.insert(points.end(), begin + (has_own_base(line) ? 0 : 1), begin + given_.n_steps(line) + 1);
    });
    for (const DoubledSheets::BaseVertex& base_vertex : sheets_.base_vertices)
      mesh_.points[NodeId(lines_.first(base_vertex.sides[0].value()))] = base_vertex.point;
  }

  void keep_columns() {
    const auto n_lines = static_cast<std::ptrdiff_t>(sheets_.n_given_vertices);
    LayerBlock block;
    block.n_layers = given_.n_layers;
    if (!given_.line_layers.empty()) block.line_layers.assign(given_.line_layers.begin(), given_.line_layers.begin() + n_lines);
    if (std::ranges::all_of(block.line_layers, [&](int n) { return n == block.n_layers; })) block.line_layers.clear();
    block.first_node.assign(lines_.first().begin(), lines_.first().begin() + n_lines);
    block.is_collapsed.assign(given_.is_collapsed.begin(), given_.is_collapsed.begin() + n_lines);
    for (std::size_t column = 0; column < given_.n_columns(); ++column) {
      const auto& base = given_.base[column];
      if (column < sheets_.n_given_triangles && std::ranges::none_of(base, [&](Line line) { return is_added(line); })) {
        block.base.push_back(base);
        order_.push_back(static_cast<std::uint32_t>(column));
        continue;
      }
      if (column < sheets_.n_given_triangles) explicit_columns_.push_back(static_cast<std::uint32_t>(column));
      for (int j = 0, n = given_.layers_of_column(column); j < n; ++j)
        cells_.add_cell({node(base[0], j), node(base[1], j), node(base[2], j)}, {node(base[0], j + 1), node(base[1], j + 1), node(base[2], j + 1)}, base);
    }
    mesh_.layers = std::move(block);
    for_each_column(
        [&](auto& column) {
          if (!column.empty()) column.resize(sheets_.n_given_vertices);
        },
        mesh_.request);
  }

  void keep_faces() { lines_.move_faces(mesh_, sheets_.n_given_triangles, node_of()); }

  void reorder_boundary() {
    order_.insert(order_.end(), explicit_columns_.begin(), explicit_columns_.end());
    for (std::size_t t = sheets_.n_given_triangles; t < boundary_.triangles.size(); ++t) order_.push_back(static_cast<std::uint32_t>(t));
    lines_.reorder(boundary_, order_, node_of());
  }

  void prove() const {
    ErrorInfo info = cells_.find_invalid([](Line) {});
    if (info.n_locations == 0) return;
    info.code = ErrorCode::envelope_failed;
    info.attempted = "making the cells of wake sheets";
    info.problem = std::to_string(info.n_locations) + " cells are inverted";
    info.hint = "leave the wakes out, or give another direction or length";
    throw Error(std::move(info));
  }

  const DoubledSheets& sheets_;
  HybridMesh& mesh_;
  FillBoundary& boundary_;
  const LayerBlock given_;       ///< layer on the wall with sheets
  std::vector<Line> base_line_;  ///< for each growth line the growth line at whose first node it starts
  RenumberedLines lines_{given_};
  std::vector<std::uint32_t> order_, explicit_columns_;
  ExplicitCells cells_;
};

}  // namespace

void close_wakes(const DoubledSheets& sheets, HybridMesh& mesh, FillBoundary& boundary) { WakeCloser(sheets, mesh, boundary).close(); }

}  // namespace sterna::volmesh
