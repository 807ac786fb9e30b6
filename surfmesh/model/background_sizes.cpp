#include "surfmesh/model/background_sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace sterna::surfmesh {
namespace {

/// Sites are thinned in cells whose edge is the power of two below this fraction of the size of the site. With growth 0.2 the error of a field is at most 10 %.
constexpr double k_thinning = 0.5;

bool is_before(const SizeSite& a, const SizeSite& b) {
  return std::tie(a.size, a.point.x, a.point.y, a.point.z) < std::tie(b.size, b.point.x, b.point.y, b.point.z);
}

/// Returns the smallest site in each cell of the grid. The size of a site determines its grid.
std::vector<SizeSite> thinned(const std::vector<SizeSite>& sites, double largest) {
  struct Entry {
    std::array<std::int64_t, 4> cell;
    SizeSite site;
  };
  std::vector<Entry> entries;
  for (const SizeSite& s : sites) {
    if (!(s.size < largest)) continue;
    int level = 0;
    std::frexp(s.size, &level);
    const double side = std::ldexp(k_thinning, level);
    entries.push_back({{level, static_cast<std::int64_t>(std::floor(s.point.x / side)), static_cast<std::int64_t>(std::floor(s.point.y / side)),
                        static_cast<std::int64_t>(std::floor(s.point.z / side))},
                       s});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.cell != b.cell ? a.cell < b.cell : is_before(a.site, b.site); });
  std::vector<SizeSite> result;
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (i == 0 || entries[i].cell != entries[i - 1].cell) result.push_back(entries[i].site);
  return result;
}

}  // namespace

BackgroundSizes::BackgroundSizes(const std::vector<SizeSite>& sites, double growth, double largest, const RunContext& context)
    : sites_(thinned(sites, largest), growth, context) {}

}  // namespace sterna::surfmesh
