// Renumbers a layer whose growth lines get other nodes, because some of them start at a node of another growth line or have their own cells. Used by
// close_multi_normals and close_wakes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/columns.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/layer/assemble.h"

namespace sterna::volmesh {

/// Node numbers after growth lines got other nodes. The functions have an argument \p node: node(line, j) -> NodeId returns the present location of node j of a
/// growth line of the given block.
class RenumberedLines {
 public:
  using Line = std::uint32_t;
  /// \pre the nodes of the growth lines of \p given are the first nodes of the mesh
  explicit RenumberedLines(Borrowed<const LayerBlock> given) : given_(given) {
    for (Line line = 0; line < given_.n_lines(); ++line) n_before_ = std::max(n_before_, given_.top(line).index() + 1);
  }

  /// Renumbers the nodes of a mesh. append(line, begin, points) adds the nodes of a growth line; begin is the position of its given nodes. Points after the
  /// growth lines follow the new nodes.
  template <class Append>
  void renumber(HybridMesh& mesh, const Append& append) {
    const std::vector<Point>& old = mesh.points.raw();
    std::vector<Point> points;
    points.reserve(old.size());
    first_.resize(given_.n_lines());
    for (Line line = 0; line < first_.size(); ++line) {
      first_[line] = NodeId(points.size()).value();
      append(line, old.begin() + given_.first_node[line], points);
    }
    outer_shift_ = static_cast<std::int64_t>(points.size()) - static_cast<std::int64_t>(n_before_);
    points.insert(points.end(), old.begin() + static_cast<std::ptrdiff_t>(n_before_), old.end());
    mesh.points = Column<NodeId, Point>(std::move(points));
  }

  /// Returns the first node of a growth line; the overload without argument returns the first nodes of all growth lines.
  std::uint32_t first(Line line) const { return first_[line]; }
  std::span<const std::uint32_t> first() const { return first_; }

  /// Returns the new number of a node of the given mesh. \pre a node of a growth line is an end of the growth line, or is on the wall
  template <class NodeOf>
  NodeId moved(NodeId before, const NodeOf& node) const {
    if (before.index() >= n_before_) return NodeId(static_cast<std::uint64_t>(static_cast<std::int64_t>(before.index()) + outer_shift_));
    const auto after = std::ranges::upper_bound(given_.first_node, before.value());
    const auto line = static_cast<Line>(after - given_.first_node.begin() - 1);
    return node(line, static_cast<int>(before.value() - given_.first_node[line]));
  }

  /// Renumbers the boundary faces. Removes faces of columns from `n_columns` on, because these columns stand on no wall.
  template <class NodeOf>
  void move_faces(HybridMesh& mesh, std::size_t n_columns, const NodeOf& node) const {
    std::vector<sterna::BoundaryTriangle> faces;
    for (std::size_t t = 0; t < mesh.boundary_triangles.size(); ++t) {
      if (t >= n_columns && t < given_.n_columns()) continue;
      sterna::BoundaryTriangle face = mesh.boundary_triangles[t];
      for (NodeId& n : face.nodes) n = moved(n, node);
      faces.push_back(face);
    }
    std::vector<BoundaryQuad> quads;
    for (BoundaryQuad quad : mesh.boundary_quads) {
      for (NodeId& n : quad.nodes) n = moved(n, node);
      // The two growth lines have the same base vertex.
      if (quad.nodes[0] == quad.nodes[1]) faces.push_back({{quad.nodes[0], quad.nodes[2], quad.nodes[3]}, quad.patch});
      else quads.push_back(quad);
    }
    mesh.boundary_triangles = std::move(faces);
    mesh.boundary_quads = std::move(quads);
  }

  /// Sorts the triangles on the boundary of the tetrahedra in the given order of the old triangles, and updates the nodes of its points.
  template <class NodeOf>
  void reorder(FillBoundary& boundary, std::span<const std::uint32_t> order, const NodeOf& node) const {
    const auto take = [&](auto& column) {
      auto before = std::move(column);
      column.clear();
      for (const std::uint32_t t : order) column.push_back(before[t]);
    };
    take(boundary.triangles);
    take(boundary.triangle_patch);
    take(boundary.layer_volumes);
    for (std::size_t p = 0; p < boundary.point2node.size(); ++p)
      boundary.point2node[p] =
          p < given_.n_lines() ? node(static_cast<Line>(p), given_.layers_of_line(static_cast<Line>(p))) : moved(boundary.point2node[p], node);
  }

 private:
  const LayerBlock& given_;
  std::vector<std::uint32_t> first_;
  std::size_t n_before_ = 0;  ///< number of nodes on growth lines in the given mesh
  std::int64_t outer_shift_ = 0;
};

}  // namespace sterna::volmesh
