#include "surfmesh/model/background_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace sterna::surfmesh {
namespace {

/// Size points are thinned in cells whose edge is the power of two below this fraction of the size of the size point. With growth 0.2 the error of a field is
/// at most 10 %.
constexpr double k_thinning = 0.5;

bool is_before(const SizePoint& a, const SizePoint& b) {
  return std::tie(a.size, a.point.x, a.point.y, a.point.z) < std::tie(b.size, b.point.x, b.point.y, b.point.z);
}

/// Returns the smallest size point in each cell of the grid. The size of a size point determines its grid.
std::vector<SizePoint> thinned(const std::vector<SizePoint>& size_points, double largest) {
  struct Entry {
    std::array<std::int64_t, 4> cell;
    SizePoint size_point;
  };
  std::vector<Entry> entries;
  for (const SizePoint& s : size_points) {
    if (!(s.size < largest)) continue;
    int level = 0;
    std::frexp(s.size, &level);
    const double side = std::ldexp(k_thinning, level);
    entries.push_back({{level, static_cast<std::int64_t>(std::floor(s.point.x / side)), static_cast<std::int64_t>(std::floor(s.point.y / side)),
                        static_cast<std::int64_t>(std::floor(s.point.z / side))},
                       s});
  }
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.cell != b.cell ? a.cell < b.cell : is_before(a.size_point, b.size_point); });
  std::vector<SizePoint> result;
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (i == 0 || entries[i].cell != entries[i - 1].cell) result.push_back(entries[i].size_point);
  return result;
}

}  // namespace

BackgroundSizes::BackgroundSizes(const std::vector<SizePoint>& size_points, double growth, double largest, const RunContext& context)
    : size_points_(thinned(size_points, largest), growth, context) {}

}  // namespace sterna::surfmesh
