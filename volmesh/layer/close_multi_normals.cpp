// Steps: number_nodes; move_lines (ends of ridges get one layer less); fill (columns that stay, and explicit cells); reorder the boundary; check the explicit
// cells.
#include "volmesh/layer/close_multi_normals.h"

#include <algorithm>
#include <array>
#include <string>

#include "geom/base/columns.h"
#include "geom/base/sort_unique.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/layer/explicit_cells.h"
#include "volmesh/layer/renumbered_lines.h"

namespace sterna::volmesh {
namespace {

/// Returns the same curve with one layer less. The height of the first cell is kept, and the others grow slightly more. \p nodes from the wall up; the last
/// node stays
std::vector<Point> with_layer_less(const std::vector<Point>& nodes) {
  std::vector<double> along = {0.0};
  for (std::size_t j = 1; j < nodes.size(); ++j) along.push_back(along.back() + distance(nodes[j - 1], nodes[j]));
  const std::size_t n = nodes.size() - 2;
  std::vector<double> t(n + 1);
  layer_parameters(along[1], along.back(), static_cast<int>(n), t.data());
  std::vector<Point> result = {nodes[0]};
  std::size_t k = 0;
  for (std::size_t j = 1; j < n; ++j) {
    const double s = t[j] * along.back();
    while (k + 2 < along.size() && along[k + 1] < s) ++k;
    result.push_back(nodes[k] + (s - along[k]) / (along[k + 1] - along[k]) * (nodes[k + 1] - nodes[k]));
  }
  result.push_back(nodes.back());
  return result;
}

class MultiNormalCloser {
 public:
  MultiNormalCloser(const OpenedRidges& ridges, HybridMesh& mesh, FillBoundary& boundary)
      : ridges_(ridges),
        mesh_(mesh),
        boundary_(boundary),
        given_(mesh.layers),
        n_lines_(ridges.n_given_vertices),
        is_end_(ridges.base_vertex.size(), 0),
        cells_(mesh) {
    for (const VertexId v : ridges.end_vertices) is_end_[v.index()] = 1;
  }

  void close() {
    require_standing_lines();
    number_nodes();
    fill();
    reorder_boundary();
    prove();
  }

 private:
  using Line = std::uint32_t;
  bool is_added(Line line) const { return line >= n_lines_; }
  int n_layers(Line line) const { return given_.layers_of_line(line); }
  Line base_vertex(Line line) const { return ridges_.base_vertex[VertexId(line)].value(); }
  bool is_collapsed(Line line) const { return given_.is_collapsed[line] != 0; }

  /// Returns node j of a growth line. Growth lines with a common ridge base vertex meet in node 0. Growth lines at ends of ridges start one layer later.
  NodeId node(Line line, int j) const {
    if (j == 0 || is_collapsed(line)) return NodeId(lines_.first(base_vertex(line)));
    if (is_added(line)) return NodeId(lines_.first(line) + static_cast<std::uint32_t>(j) - 1);
    if (is_end_[line]) return NodeId(lines_.first(line) + static_cast<std::uint32_t>(j - 1));
    return NodeId(lines_.first(line) + static_cast<std::uint32_t>(j));
  }
  NodeId top(Line line) const { return node(line, n_layers(line)); }

  void require_standing_lines() const {
    std::vector<VertexId> base_vertices;
    ErrorInfo info;
    const auto look_at = [&](VertexId v) {
      if (!is_collapsed(v.value()) && n_layers(v.value()) > 2) return;
      info.add_location(mesh_.points.raw()[given_.first_node[v.value()]], "vertex " + std::to_string(v.value()));
      for (const VertexId f : base_vertices_at(v.value())) base_vertices.push_back(f);
    };
    for (const VertexId v : ridges_.base_vertex.ids())
      if (is_added(v.value()) || ridges_.base_vertex[v] != v || is_end_[v.index()]) look_at(v);
    for (const OpenedRidges::BaseVertex& f : ridges_.base_vertices) look_at(f.vertex);
    if (!base_vertices.empty()) fail(std::move(info), "multi-normal fans have growth lines with fewer than three layers", std::move(base_vertices));
  }

  /// Returns the ridge base vertices of the multi-normal fans that contain a growth line or end at it.
  std::vector<VertexId> base_vertices_at(Line line) const {
    if (!is_end_[line]) return {VertexId(base_vertex(line))};
    std::vector<VertexId> base_vertices;
    for (const auto& t : ridges_.ends)
      if (t[0].value() == line) base_vertices.push_back(ridges_.base_vertex[t[1]]);
    return base_vertices;
  }

  [[noreturn]] static void fail(ErrorInfo info, std::string problem, std::vector<VertexId> base_vertices) {
    sort_unique(base_vertices);
    info.code = ErrorCode::envelope_failed;
    info.attempted = "making the cells of opened ridges";
    info.problem = std::move(problem);
    info.hint = "set open_ridges = \"never\", or a larger open_angle";
    throw MultiNormalError(std::move(info), std::move(base_vertices));
  }

  auto node_of() const {
    return [this](Line line, int j) { return node(line, j); };
  }

  void number_nodes() {
    lines_.renumber(mesh_, [&](Line line, auto begin, std::vector<Point>& points) {
      std::vector<Point> nodes(begin, begin + given_.n_steps(line) + 1);
      if (is_added(line)) nodes.erase(nodes.begin());
      else if (is_end_[line]) nodes = with_layer_less(nodes);
      points.insert(points.end(), nodes.begin(), nodes.end());
    });
    for (const OpenedRidges::BaseVertex& f : ridges_.base_vertices) mesh_.points[NodeId(lines_.first(f.vertex.value()))] = f.point;
  }

  void fill() {
    LayerBlock block;
    block.n_layers = given_.n_layers;
    block.line_layers = given_.line_layers;
    if (block.line_layers.empty() && !ridges_.end_vertices.empty()) block.line_layers.assign(n_lines_, static_cast<std::uint16_t>(given_.n_layers));
    if (!block.line_layers.empty()) block.line_layers.resize(n_lines_);
    for (const VertexId v : ridges_.end_vertices) --block.line_layers[v.index()];
    block.first_node.assign(lines_.first().begin(), lines_.first().begin() + static_cast<std::ptrdiff_t>(n_lines_));
    block.is_collapsed.assign(given_.is_collapsed.begin(), given_.is_collapsed.begin() + static_cast<std::ptrdiff_t>(n_lines_));

    lines_.move_faces(mesh_, ridges_.n_given_triangles, node_of());
    for (std::size_t column = 0; column < ridges_.n_given_triangles; ++column) {
      const auto& base = given_.base[column];
      if (std::ranges::none_of(base, [&](Line line) { return is_added(line) || is_end_[line]; })) {
        block.base.push_back(base);
        order_.push_back(static_cast<std::uint32_t>(column));
        continue;
      }
      explicit_columns_.push_back(static_cast<std::uint32_t>(column));
      for (int j = 0; j < n_layers(base[0]); ++j) add_cell(base, j);
    }
    for (const auto& q : ridges_.quads) add_hexahedra({q[0].value(), q[1].value(), q[2].value(), q[3].value()});
    for (const auto& t : ridges_.ends) add_end({t[0].value(), t[1].value(), t[2].value()});
    for (const auto& t : ridges_.corners) add_corner({t[0].value(), t[1].value(), t[2].value()});
    mesh_.layers = std::move(block);

    LayerRequest& request = mesh_.request;
    for_each_column(
        [&](auto& column) {
          if (!column.empty()) column.resize(n_lines_);
        },
        request);
  }

  /// Adds the cell of a wall triangle in one layer.
  void add_cell(const std::array<Line, 3>& base, int j) {
    std::array<NodeId, 3> low, high;
    for (std::size_t k = 0; k < 3; ++k) low[k] = node(base[k], j), high[k] = node(base[k], j + 1);
    cells_.add_cell(low, high, base);
  }

  /// Adds the cells over a virtual quadrilateral.
  void add_hexahedra(const std::array<Line, 4>& q) {
    const int n = n_layers(q[0]);
    const auto level = [&](int j) { return std::array{node(q[0], j), node(q[1], j), node(q[2], j), node(q[3], j)}; };
    const std::array<NodeId, 4> first = level(1), base_vertex = level(0);
    cells_.add_prism({base_vertex[0], first[3], first[0], base_vertex[1], first[2], first[1]}, q);
    for (int j = 1; j + 1 < n; ++j) {
      const auto low = level(j), high = level(j + 1);
      cells_.add_hexahedron({low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]}, q);
    }
    const auto low = level(n - 1), high = level(n);
    Point middle;
    for (std::size_t k = 0; k < 4; ++k) middle += (mesh_.points[low[k]] + mesh_.points[high[k]]) / 8.0;
    const NodeId centre = mesh_.points.push_back(middle);
    cells_.add_pyramid({low[0], low[1], low[2], low[3], centre}, q);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = (k + 1) % 4;
      cells_.add_pyramid({low[k], high[k], high[next], low[next], centre}, q);
    }
    cells_.add_tet({high[0], high[2], high[1], centre}, q);
    cells_.add_tet({high[0], high[3], high[2], centre}, q);
  }

  /// Adds the cells over the virtual triangle at the end of a ridge; the first growth line is that of the end.
  void add_end(const std::array<Line, 3>& t) {
    cells_.add_tet({node(t[0], 0), node(t[2], 1), node(t[1], 1), node(t[1], 0)}, t);
    for (int j = 1; j < n_layers(t[0]); ++j) add_cell(t, j);
  }

  /// Adds the cells over a virtual triangle of a corner, whose three growth lines have a common ridge base vertex.
  void add_corner(const std::array<Line, 3>& t) {
    cells_.add_tet({node(t[0], 1), node(t[2], 1), node(t[1], 1), node(t[0], 0)}, t);
    for (int j = 1; j < n_layers(t[0]); ++j) add_cell(t, j);
  }

  void reorder_boundary() {
    order_.insert(order_.end(), explicit_columns_.begin(), explicit_columns_.end());
    for (std::size_t t = ridges_.n_given_triangles; t < boundary_.triangles.size(); ++t) order_.push_back(static_cast<std::uint32_t>(t));
    lines_.reorder(boundary_, order_, node_of());
    for (std::size_t t = order_.size(); t-- > 0;)
      if (order_[t] >= ridges_.n_given_triangles && order_[t] < given_.n_columns()) boundary_.layer_volumes[t] = 0.0;  // there is no prism below this triangle
  }

  void prove() const {
    std::vector<VertexId> base_vertices;
    ErrorInfo info = cells_.find_invalid([&](Line line) {
      for (const VertexId base_vertex : base_vertices_at(line)) base_vertices.push_back(base_vertex);
    });
    if (!base_vertices.empty()) fail(std::move(info), "cells of multi-normal fans are inverted", std::move(base_vertices));
  }

  const OpenedRidges& ridges_;
  HybridMesh& mesh_;
  FillBoundary& boundary_;
  const LayerBlock given_;  ///< layer on the opened wall
  std::size_t n_lines_;     ///< number of growth lines of the given wall
  std::vector<std::uint8_t> is_end_;
  RenumberedLines lines_{given_};
  std::vector<std::uint32_t> order_, explicit_columns_;
  ExplicitCells cells_;
};

}  // namespace

void close_multi_normals(const OpenedRidges& ridges, HybridMesh& mesh, FillBoundary& boundary) { MultiNormalCloser(ridges, mesh, boundary).close(); }

}  // namespace sterna::volmesh
