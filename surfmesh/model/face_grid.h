// A face's (u, v) divided into cells about as large as the edges wanted there: what sizes are kept on.
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
  double bound = 0.0;      ///< m: no edge here is wanted shorter
  bool is_inside = false;  ///< of the face's border
};
/// Corners in the order (u0, v0), (u1, v0), (u0, v1), (u1, v1).
struct FaceGridCell {
  std::array<std::uint32_t, 4> nodes{};
  bool is_used = false;   ///< inside, or crossed by the border
  bool is_level = false;  ///< nobody in it or near it wants less than the largest size
};

/// Halved again and again, the longer side in space first. A value.
class FaceGrid {
 public:
  /// What is known of sizes before they are carried over the surface.
  struct Bounds {
    std::function<double(const Point&)> at;                     ///< m: no edge at a point is wanted shorter
    std::function<bool(const Point&, double)> is_level_within;  ///< no edge within a distance of a point is wanted shorter than `largest`
    double largest = 0.0;                                       ///< m
  };
  FaceGrid() = default;
  /// Cells inside or crossed by `loops` (closed polygons, parity) are at most k_cell_sizes times the bound at their corners long, where sizes are not level.
  FaceGrid(const Surface& surface, const ParameterBox& box, std::span<const std::vector<Uv>> loops, const Bounds& bounds);

  bool empty() const { return tree_.empty(); }
  const std::vector<FaceGridNode>& nodes() const { return nodes_; }
  const std::vector<FaceGridCell>& cells() const { return leaves_; }
  /// Nodes on the sides of a cell that are corners of smaller cells beside it; by cell.
  struct Hanging {
    std::uint32_t cell = 0, node = 0;
    friend auto operator<=>(const Hanging&, const Hanging&) = default;
  };
  const std::vector<Hanging>& hanging() const { return hanging_; }
  struct Place {
    std::uint32_t cell = 0;
    double s = 0.0, t = 0.0;  ///< in [0, 1] within the cell
  };
  /// Places beyond the box are moved into it by whole periods, or held to it.
  Place find(Uv at) const;
  /// Frees what look-ups do not need.
  void forget_nodes();

 private:
  friend class FaceGridBuilder;
  static constexpr std::uint32_t k_is_leaf = 0x8000'0000u, k_is_v = 0x4000'0000u, k_index = 0x3fff'ffffu;
  ParameterBox box_;
  Uv period_;                        ///< zero: not periodic
  std::vector<std::uint32_t> tree_;  ///< k_is_leaf | cell, or k_is_v (halved in v) | first of two children
  std::vector<FaceGridCell> leaves_;
  std::vector<FaceGridNode> nodes_;
  std::vector<Hanging> hanging_;
};

}  // namespace sterna::surfmesh
