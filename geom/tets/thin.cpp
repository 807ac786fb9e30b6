// There is a hash grid for each power of two. Its cells are at least as long as the distances of that size.

#include "geom/tets/thin.h"

#include <array>
#include <bit>
#include <cmath>

namespace sterna::tets {
namespace {

struct Cell {
  std::array<std::int64_t, 3> at;
  int level = 0;
  bool operator==(const Cell&) const = default;
};

std::uint64_t hash_of(const Cell& cell) {
  std::uint64_t h = static_cast<std::uint64_t>(cell.level) * 0x9e3779b97f4a7c15ull;
  for (const std::int64_t x : cell.at) h = (h ^ static_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccdull, h ^= h >> 29;
  return h;
}

}  // namespace

std::vector<std::uint32_t> thinned(std::span<const Seed> seeds, std::span<const std::uint32_t> order) {
  std::vector<std::uint32_t> kept;
  kept.reserve(order.size());
  std::vector<Cell> cells;  // cells of the kept seeds
  std::vector<std::uint32_t> next;
  const std::size_t last = std::bit_ceil(2 * order.size() + 1) - 1;
  std::vector<std::uint32_t> heads(last + 1, k_none);  // lists are found by hash only: cells with the same hash share a list
  for (const std::uint32_t i : order) {
    const Vec3& p = seeds[i].position;
    const double distance = seeds[i].room.to_points;
    if (!(distance > 0.0)) {
      kept.push_back(i);
      cells.push_back({});
      next.push_back(k_none);
      continue;
    }
    const int level = std::ilogb(distance) + 1;
    const double cells_per_metre = std::ldexp(1.0, -level);
    std::array<std::int64_t, 3> low, high;
    Cell own{.at = {}, .level = level};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = static_cast<std::int64_t>(std::floor((p[axis] - distance) * cells_per_metre));
      high[axis] = static_cast<std::int64_t>(std::floor((p[axis] + distance) * cells_per_metre));
      own.at[axis] = static_cast<std::int64_t>(std::floor(p[axis] * cells_per_metre));
    }
    bool is_free = true;
    Cell cell{.at = {}, .level = level};
    for (cell.at[0] = low[0]; is_free && cell.at[0] <= high[0]; ++cell.at[0]) {
      for (cell.at[1] = low[1]; is_free && cell.at[1] <= high[1]; ++cell.at[1]) {
        for (cell.at[2] = low[2]; is_free && cell.at[2] <= high[2]; ++cell.at[2]) {
          for (std::uint32_t k = heads[hash_of(cell) & last]; is_free && k != k_none; k = next[k])
            is_free = !(cells[k] == cell) || norm2(seeds[kept[k]].position - p) >= distance * distance;
        }
      }
    }
    if (!is_free) continue;
    std::uint32_t& head = heads[hash_of(own) & last];
    next.push_back(head);
    head = static_cast<std::uint32_t>(kept.size());
    cells.push_back(own);
    kept.push_back(i);
  }
  return kept;
}

}  // namespace sterna::tets
