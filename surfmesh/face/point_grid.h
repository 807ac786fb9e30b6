// Points sorted into the cells of a uniform grid, for queries by distance.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

struct GridPoint {
  Point point;
  std::uint32_t id = 0;
};

class PointGrid {
 public:
  PointGrid() = default;
  /// Sorts the points into cells of a few points each.
  explicit PointGrid(std::vector<GridPoint> points) {
    Box box;
    for (const GridPoint& p : points) box.add(p.point);
    if (box.empty()) return;
    constexpr double k_cells_by_side = 64.0;  // Border points lie along lines: with this many cells per side, each cell holds few points
    low_ = box.min;
    side_ = std::max(box.longest_side() / k_cells_by_side, 1e-300);
    for (const GridPoint& p : points) entries_.push_back({cell_of(p.point), p});
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.cell != b.cell ? a.cell < b.cell : a.point.id < b.point.id; });
  }
  /// Calls visit(point) for all points within `reach` metres, and for some farther ones.
  template <class Visit>
  void for_each_near(const Point& p, double reach, const Visit& visit) const {
    const Vec3 r{reach, reach, reach};
    const Cell low = cell_of(p - r), high = cell_of(p + r);
    for (std::int32_t i = std::max(low[0], 0); i <= std::min(high[0], k_last); ++i)
      for (std::int32_t j = std::max(low[1], 0); j <= std::min(high[1], k_last); ++j) {
        const Cell from{i, j, low[2]}, to{i, j, high[2]};
        for (auto at = std::lower_bound(entries_.begin(), entries_.end(), from, [](const Entry&e, const Cell&c) { return e.cell < c; });
             at != entries_.end() && at->cell <= to; ++at)
          visit(at->point);
      }
  }

 private:
  using Cell = std::array<std::int32_t, 3>;
  static constexpr std::int32_t k_last = 64;
  struct Entry {
    Cell cell;
    GridPoint point;
  };
  Cell cell_of(const Point& p) const {
    const auto index = [&](double x, double low) {
      return static_cast<std::int32_t>(std::clamp(std::floor((x - low) / side_), -1.0, static_cast<double>(k_last) + 1.0));
    };
    return {index(p.x, low_.x), index(p.y, low_.y), index(p.z, low_.z)};
  }

  Point low_;
  double side_ = 1.0;
  std::vector<Entry> entries_;
};

}  // namespace sterna::surfmesh
