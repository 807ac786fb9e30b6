// Shared by the dual_*.cpp files only: the two algorithms for the metrics of a node, and the selection between them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/mesh/dual_metrics.h"
#include "geom/mesh/lanes.h"
#include "geom/mesh/node_subset.h"

namespace sterna::dual_parts {

/// Relative margin for sub-tets that are certain to be positive. A sub-tet is certainly above k_solver_margin (computed_volumes.h) if six times its volume
/// exceeds this factor times the cube of the cell's size. The size is measured from the corner (root of the sum of squared edges from there): two of the
/// sub-tet's three vectors are at most that long, the third at most half as long. The rounding error of the formulas here, at most 64 units, is less than the
/// difference. Sub-tets of a prism of aspect ratio 1e9 are still certain.
inline constexpr double k_certain = 1e-13;
/// Factor of the absolute part of that margin, which is the factor times the distance of the cell from the origin times the square of the size. Solvers round
/// midpoints and centroids as coordinates, with an error of one to eight units of the distance each.
inline constexpr double k_location_rounding = 32 * 0x1p-53;
/// Returns the bound of six times the volume above which a sub-tet is certain. \p reach: distance of the corner from the origin; \p size2: square of the
/// size.
template <class T>
T certain_sub_volume(const T& reach, const T& size, const T& size2) {
  return size2 * (k_certain * size + k_location_rounding * (reach + size));
}
/// Rounding error of the dual faces around a node, relative to its number of edges times the square of the longest edge. Each face has six cross products of
/// such edges, with differences before them.
inline constexpr double k_face_rounding = 96 * 0x1p-53;
/// Largest closure that is explained by rounding: around cells of length-to-width ratio 1e5, rounding alone contributes 1e-11 of the faces.
inline constexpr double k_rounding_closure = 0x1p-40;

/// Columns around each line.
class LineRings {
 public:
  explicit LineRings(const LayerBlock& layers);
  std::span<const std::uint32_t> columns(std::uint32_t line) const { return {columns_.data() + first_[line], first_[line + 1] - first_[line]}; }

 private:
  std::vector<std::uint32_t> first_, columns_;
};

/// Returns 1 for regular lines: not collapsed and closed all around by columns of prisms. Nodes inside their columns belong to those prisms only.
std::vector<std::uint8_t> find_regular_lines(const LayerBlock& layers, const LineRings& rings, const RunContext& context);

/// Computes the metrics of the inner nodes of regular lines, line by line, vectorised over the layers.
class LineDual {
 public:
  LineDual(Borrowed<const HybridMesh> mesh, Borrowed<const LineRings> rings);
  /// Returns the metrics of layers 1 .. n - 1 of a regular line of n layers; valid until the next call.
  std::span<const NodeMetrics> measure(std::uint32_t line);
  std::vector<std::uint64_t> take_suspects() { return std::move(suspects_); }

 private:
  /// Dual faces of one edge along the layer, by layer. `above` is the part from the prisms above; `below` is the part from the prisms below, stored at their
  /// upper layer.
  struct Slot {
    std::uint32_t line = 0;
    lanes::LineVectors above, below;
  };
  Slot& slot_of(std::uint32_t line);
  void add_column(std::uint32_t column, const lanes::LineVectors& b, const lanes::LineVectors& c, Slot& to_b, Slot& to_c);
  void reset();
  void finish(std::size_t n_layers);

  const HybridMesh& mesh_;
  const LineRings& rings_;
  std::size_t n_padded_;  ///< padded number of nodes of the longest line
  lanes::LineVectors own_;
  std::vector<lanes::LineVectors> neighbours_;  ///< by slot
  std::vector<Slot> slots_;
  std::size_t n_slots_ = 0;
  lanes::LineVectors upward_;  ///< dual faces of the edges of the line
  std::vector<double> least_above_, most_above_, sum_above_, least_below_, most_below_, sum_below_;
  std::vector<NodeMetrics> metrics_;
  std::vector<std::uint64_t> suspects_;
};

/// Computes the metrics of any node from the cells and boundary faces around it. Used for all nodes that LineDual does not cover.
class NodeDual {
 public:
  NodeDual(Borrowed<const HybridMesh> mesh, Borrowed<const LineRings> rings);
  /// Measures a node of a line (`line` valid) or off lines (NodeId::k_invalid). `cells` lists explicit cells and boundary faces by common number, in the order
  /// of `first_`.
  NodeMetrics measure(std::uint32_t node, std::uint32_t line, std::span<const std::uint32_t> cells);
  std::vector<std::uint64_t> take_suspects() { return std::move(suspects_); }

 private:
  struct Edge {
    std::uint32_t other;
    bool is_stack;
    Vec3 normal;
    bool is_flat = false;  ///< edge of a triangle of a prism
  };
  struct BoundaryPiece {
    PatchId patch;
    Vec3 normal;
  };
  struct Corner {
    std::uint8_t next, previous;  ///< neighbours of the corner on the face
    std::uint8_t size;
    std::array<std::uint8_t, 4> nodes;
  };
  Edge& edge_to(std::uint32_t other);
  void add_columns(std::uint32_t line, std::uint32_t layer);
  void add_cell(CellKind kind, std::span<const NodeId> nodes, std::uint64_t number);
  void add_tet(std::span<const NodeId> nodes, std::uint64_t number);
  void add_boundary(std::span<const NodeId> nodes, PatchId patch);
  void add_sub_volume(double six_times);
  NodeMetrics result(std::uint32_t line) const;

  const HybridMesh& mesh_;
  const LineRings& rings_;
  std::array<std::array<std::vector<Corner>, 8>, 4> corners_;  ///< faces of each corner, by kind
  std::array<std::uint64_t, 6> first_;                         ///< numbers of explicit prisms, pyramids, hexahedra, tets, boundary triangles, quads
  std::uint32_t node_ = 0;
  Point origin_;
  double reach_ = 0.0;  ///< m, distance of the node from the origin of coordinates
  std::vector<Edge> edges_;
  std::vector<BoundaryPiece> pieces_;
  double least_ = 0.0, most_ = 0.0, sum_ = 0.0;
  bool has_hexahedron_ = false;
  std::vector<std::uint64_t> suspects_;
};

}  // namespace sterna::dual_parts
