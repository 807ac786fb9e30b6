#include "scripting/report/thin_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace sterna::scripting {
namespace {

/// Maximum number of cubes per axis, counted from the corner of the box; 21 bits per axis.
constexpr double k_most_cubes = 2e6;
/// Growth factor of the cube width until the number of triangles is small enough.
constexpr double k_growth = 1.25;

std::uint64_t cube_of(const Point& p, const Point& low, double width) {
  const auto along = [&](double x) { return static_cast<std::uint64_t>(x / width); };
  return along(p.x - low.x) << 42 | along(p.y - low.y) << 21 | along(p.z - low.z);
}

/// Returns the representative of each point.
std::vector<std::uint32_t> representatives(std::span<const Point> points, std::span<const std::uint32_t> used, const Point& low, double width) {
  struct Cube {
    Vec3 sum{};
    double n = 0.0, nearest = std::numeric_limits<double>::infinity();
    std::uint32_t point = 0;
  };
  std::unordered_map<std::uint64_t, Cube> cubes;
  for (const std::uint32_t i : used) {
    Cube& cube = cubes[cube_of(points[i], low, width)];
    cube.sum = cube.sum + points[i];
    cube.n += 1.0;
  }
  for (const std::uint32_t i : used) {
    Cube& cube = cubes[cube_of(points[i], low, width)];
    const double off = distance(points[i], cube.sum / cube.n);
    if (off < cube.nearest) {
      cube.nearest = off;
      cube.point = i;
    }
  }
  std::vector<std::uint32_t> of(points.size(), 0);
  for (const std::uint32_t i : used) of[i] = cubes[cube_of(points[i], low, width)].point;
  return of;
}

ThinSurface joined(std::span<const std::array<std::uint32_t, 3>> triangles, const std::vector<std::uint32_t>& of) {
  struct Entry {
    std::array<std::uint32_t, 3> sorted;
    std::uint32_t source;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<std::uint32_t, 3> c = {of[triangles[t][0]], of[triangles[t][1]], of[triangles[t][2]]};
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    std::sort(c.begin(), c.end());
    entries.push_back({c, static_cast<std::uint32_t>(t)});
  }
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.sorted == b.sorted; }), entries.end());
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.source < b.source; });
  ThinSurface thin;
  for (const Entry& entry : entries) {
    const auto& t = triangles[entry.source];
    thin.triangles.push_back({of[t[0]], of[t[1]], of[t[2]]});
    thin.source.push_back(entry.source);
  }
  return thin;
}

}  // namespace

ThinSurface thin_surface(std::span<const Point> points, std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t most) {
  if (triangles.size() <= most) {
    ThinSurface all{{triangles.begin(), triangles.end()}, std::vector<std::uint32_t>(triangles.size())};
    std::iota(all.source.begin(), all.source.end(), 0u);
    return all;
  }
  std::vector<std::uint32_t> used;
  for (const auto& t : triangles) used.insert(used.end(), t.begin(), t.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  Point low = points[used.front()], high = low;
  for (const std::uint32_t i : used) {
    const Point& p = points[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  // The first cube width is the mean edge length. A cube then holds about one vertex, which is certainly too fine.
  double edges = 0.0;
  for (const auto& t : triangles) edges += distance(points[t[0]], points[t[1]]);
  double width = std::max(edges / static_cast<double>(triangles.size()), std::max({high.x - low.x, high.y - low.y, high.z - low.z}) / k_most_cubes);
  for (;; width *= k_growth) {
    ThinSurface thin = joined(triangles, representatives(points, used, low, width));
    if (thin.triangles.size() <= most) return thin;
  }
}

}  // namespace sterna::scripting
