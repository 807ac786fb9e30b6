// Steps: number_nodes, fill (columns that stay, explicit cells, boundary faces), reorder the boundary of the tetrahedra, prove the explicit cells.
#include "volmesh/layer/close_wakes.h"

#include <algorithm>
#include <array>
#include <string>

#include "geom/base/columns.h"
#include "geom/base/error.h"
#include "volmesh/layer/explicit_cells.h"

namespace sterna::volmesh {
namespace {

class WakeCloser {
 public:
  WakeCloser(const DoubledSheets& sheets, HybridMesh& mesh, FillBoundary& boundary)
      : sheets_(sheets), mesh_(mesh), boundary_(boundary), given_(mesh.layers), foot_(mesh.layers.n_lines()), cells_(mesh) {
    for (std::size_t line = 0; line < foot_.size(); ++line) foot_[line] = static_cast<Line>(line);
    for (const DoubledSheets::Foot& foot : sheets.feet) foot_[foot.sides[1].index()] = foot.sides[0].value();
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
  bool has_own_foot(Line line) const { return foot_[line] == line; }

  NodeId node(Line line, int j) const {
    const int at = std::min(j, given_.n_steps(line));
    if (at == 0) return NodeId(first_[foot_[line]]);
    return NodeId(first_[line] + static_cast<std::uint32_t>(has_own_foot(line) ? at : at - 1));
  }

  void number_nodes() {
    const std::size_t n_lines = given_.n_lines();
    for (Line line = 0; line < n_lines; ++line) n_before_ = std::max(n_before_, given_.top(line).index() + 1);
    const std::vector<Point>& old = mesh_.points.raw();
    std::vector<Point> points;
    points.reserve(old.size());
    first_.resize(n_lines);
    for (Line line = 0; line < n_lines; ++line) {
      first_[line] = NodeId(points.size()).value();
      const auto begin = old.begin() + given_.first_node[line];
      points.insert(points.end(), begin + (has_own_foot(line) ? 0 : 1), begin + given_.n_steps(line) + 1);
    }
    for (const DoubledSheets::Foot& foot : sheets_.feet) points[first_[foot.sides[0].index()]] = foot.point;
    outer_shift_ = static_cast<std::int64_t>(points.size()) - static_cast<std::int64_t>(n_before_);
    points.insert(points.end(), old.begin() + static_cast<std::ptrdiff_t>(n_before_), old.end());
    mesh_.points = Column<NodeId, Point>(std::move(points));
  }

  NodeId moved(NodeId before) const {
    if (before.index() >= n_before_) return NodeId(static_cast<std::uint64_t>(static_cast<std::int64_t>(before.index()) + outer_shift_));
    const auto after = std::ranges::upper_bound(given_.first_node, before.value());
    const auto line = static_cast<Line>(after - given_.first_node.begin() - 1);
    return node(line, static_cast<int>(before.value() - given_.first_node[line]));
  }

  void keep_columns() {
    const auto n_lines = static_cast<std::ptrdiff_t>(sheets_.n_given_vertices);
    LayerBlock block;
    block.n_layers = given_.n_layers;
    if (!given_.line_layers.empty()) block.line_layers.assign(given_.line_layers.begin(), given_.line_layers.begin() + n_lines);
    block.first_node.assign(first_.begin(), first_.begin() + n_lines);
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

  void keep_faces() {
    std::vector<sterna::BoundaryTriangle> faces;
    for (std::size_t t = 0; t < mesh_.boundary_triangles.size(); ++t) {
      if (t >= sheets_.n_given_triangles && t < given_.n_columns()) continue;  // of a sheet
      sterna::BoundaryTriangle face = mesh_.boundary_triangles[t];
      for (NodeId& n : face.nodes) n = moved(n);
      faces.push_back(face);
    }
    mesh_.boundary_triangles = std::move(faces);
    for (BoundaryQuad& quad : mesh_.boundary_quads)
      for (NodeId& n : quad.nodes) n = moved(n);
  }

  void reorder_boundary() {
    order_.insert(order_.end(), explicit_columns_.begin(), explicit_columns_.end());
    for (std::size_t t = sheets_.n_given_triangles; t < boundary_.triangles.size(); ++t) order_.push_back(static_cast<std::uint32_t>(t));
    const auto reorder = [&](auto& column) {
      auto before = std::move(column);
      column.clear();
      for (const std::uint32_t t : order_) column.push_back(before[t]);
    };
    reorder(boundary_.triangles);
    reorder(boundary_.triangle_patch);
    reorder(boundary_.layer_volumes);
    for (std::size_t p = 0; p < boundary_.point2node.size(); ++p)
      boundary_.point2node[p] = p < foot_.size() ? node(static_cast<Line>(p), given_.n_layers) : moved(boundary_.point2node[p]);
  }

  void prove() const {
    ErrorInfo info = cells_.find_invalid([](Line) {});
    if (info.n_places == 0) return;
    info.code = ErrorCode::envelope_failed;
    info.attempted = "making the cells of wake sheets";
    info.problem = std::to_string(info.n_places) + " cells are inverted";
    info.hint = "leave the wakes out, or give them another direction or length";
    throw Error(std::move(info));
  }

  const DoubledSheets& sheets_;
  HybridMesh& mesh_;
  FillBoundary& boundary_;
  const LayerBlock given_;            ///< on the wall with sheets
  std::vector<Line> foot_;            ///< of each line: the one whose first node it starts at
  std::vector<std::uint32_t> first_;  ///< of each line: its first own node
  std::size_t n_before_ = 0;          ///< nodes of lines in the given mesh
  std::int64_t outer_shift_ = 0;
  std::vector<std::uint32_t> order_, explicit_columns_;
  ExplicitCells cells_;
};

}  // namespace

void close_wakes(const DoubledSheets& sheets, HybridMesh& mesh, FillBoundary& boundary) {
  if (!sheets.is_empty()) WakeCloser(sheets, mesh, boundary).close();
}

}  // namespace sterna::volmesh
