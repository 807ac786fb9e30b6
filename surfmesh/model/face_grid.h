// Divides the (u, v) of a face into cells about as large as the target edges there. Sizes are stored on this grid.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geom/model/surface.h"

namespace sterna::surfmesh {

struct FaceGridNode {
  Uv uv;
  Point point;
  double bound = 0.0;      ///< m: lower limit of the target edge length here
  bool is_inside = false;  ///< inside the face's border
};
/// Corners in the order (u0, v0), (u1, v0), (u0, v1), (u1, v1).
struct FaceGridCell {
  std::array<std::uint32_t, 4> nodes{};
  bool is_used = false;   ///< the cell is inside the border, or the border crosses it
  bool is_level = false;  ///< the target size equals the largest size everywhere in the cell and near it
};

/// Grid made by repeated bisection of the box. The side that is longer in space is halved first. A value type.
class FaceGrid {
 public:
  /// Bounds of the sizes that are known before sizes are carried over the surface.
  struct Bounds {
    std::function<double(const Point&)> at;                     ///< m: lower limit of the target edge length at a point
    std::function<bool(const Point&, double)> is_level_within;  ///< returns true if no edge within a distance of a point has a target below `largest`
    double largest = 0.0;                                       ///< m, largest size
  };
  FaceGrid() = default;
  /// Creates cells. Cells inside `loops` (closed polygons, tested by parity) or crossed by them are at most k_cell_sizes times as long as the bound at their
  /// corners, unless sizes are level there.
  FaceGrid(const Surface& surface, const ParameterBox& box, std::span<const std::vector<Uv>> loops, const Bounds& bounds);

  bool empty() const { return tree_.empty(); }
  const std::vector<FaceGridNode>& nodes() const { return nodes_; }
  const std::vector<FaceGridCell>& cells() const { return leaves_; }
  /// Node on the side of a cell that is a corner of a smaller neighbour. Nodes are sorted by cell.
  struct Hanging {
    std::uint32_t cell = 0, node = 0;
    friend auto operator<=>(const Hanging&, const Hanging&) = default;
  };
  const std::vector<Hanging>& hanging() const { return hanging_; }
  struct Location {
    std::uint32_t cell = 0;
    double s = 0.0, t = 0.0;  ///< location within the cell, in [0, 1]
  };
  /// Finds the cell of a parameter location. Locations outside the box are moved into it by whole periods, or clamped to it.
  Location find(Uv at) const;
  /// Frees the data that look-ups do not need.
  void forget_nodes();

 private:
  friend class FaceGridBuilder;
  static constexpr std::uint32_t k_is_leaf = 0x8000'0000u, k_is_v = 0x4000'0000u, k_index = 0x3fff'ffffu;
  ParameterBox box_;
  Uv period_;                        ///< periods in u and v; zero: not periodic
  std::vector<std::uint32_t> tree_;  ///< leaf: k_is_leaf | cell; other: number of the first of two children, with k_is_v if the cell is halved in v
  std::vector<FaceGridCell> leaves_;
  std::vector<FaceGridNode> nodes_;
  std::vector<Hanging> hanging_;
};

}  // namespace sterna::surfmesh
