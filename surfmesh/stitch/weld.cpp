#include "surfmesh/stitch/weld.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "geom/base/parallel.h"
#include "geom/math/predicates.h"

namespace sterna::surfmesh {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Renumbers: point i becomes target[i] (target[i] <= i, target of a kept point is itself), unused numbers closed up.
void renumber(IndexedSurface& surface, const std::vector<std::uint32_t>& target) {
  std::vector<std::uint32_t> number(surface.points.size());
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target[i] != i) continue;
    surface.points[next] = surface.points[i];
    number[i] = next++;
  }
  surface.points.resize(next);
  for (Triangle& t : surface.triangles)
    for (std::uint32_t& v : t) v = number[target[v]];
}

/// Keeps the facets for which keep(i) holds; returns how many went.
template <class Keep>
std::int64_t filter(IndexedSurface& surface, const Keep& keep) {
  std::size_t next = 0;
  const std::size_t n = surface.triangles.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!keep(i)) continue;
    surface.triangles[next] = surface.triangles[i];
    surface.patch[next] = surface.patch[i];
    ++next;
  }
  surface.triangles.resize(next);
  surface.patch.resize(next);
  return static_cast<std::int64_t>(n - next);
}

bool has_zero_area(const IndexedSurface& surface, const Triangle& t) {
  const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
  return orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 && orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

/// Corner opposite to the longest edge.
std::size_t flat_corner(const IndexedSurface& surface, const Triangle& t) {
  std::size_t corner = 0;
  double longest = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = distance(surface.points[t[(k + 1) % 3]], surface.points[t[(k + 2) % 3]]);
    if (length <= longest) continue;
    longest = length;
    corner = k;
  }
  return corner;
}

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
}

}  // namespace

std::int64_t weld_exact(IndexedSurface& surface, const RunContext& context) {
  for (Vec3& p : surface.points) p = p + Vec3{};  // -0.0 becomes 0.0
  std::vector<std::uint32_t> order(surface.points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const Vec3& p = surface.points[i];
    return std::tuple(p.x, p.y, p.z, i);
  };
  parallel_sort(context, order, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> target(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_same = i > 0 && surface.points[order[i]] == surface.points[order[i - 1]];
    target[order[i]] = is_same ? target[order[i - 1]] : order[i];  // ties are sorted by index: the lowest comes first
  }
  const std::size_t n = surface.points.size();
  renumber(surface, target);
  return static_cast<std::int64_t>(n - surface.points.size());
}

std::int64_t weld_near(IndexedSurface& surface, double tolerance, const std::vector<std::uint8_t>* only) {
  if (tolerance <= 0.0) return 0;
  std::vector<std::uint32_t> target(surface.points.size());
  std::iota(target.begin(), target.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (target[i] != i) i = target[i] = target[target[i]];
    return i;
  };
  using Key = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
  const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / tolerance)); };
  std::map<Key, std::vector<std::uint32_t>> grid;
  for (std::uint32_t i = 0; i < surface.points.size(); ++i) {
    if (only && !(*only)[i]) continue;
    const Vec3& p = surface.points[i];
    const auto [x, y, z] = Key{cell(p.x), cell(p.y), cell(p.z)};
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = grid.find({x + dx, y + dy, z + dz});
          if (found == grid.end()) continue;
          for (const std::uint32_t j : found->second) {
            if (distance(p, surface.points[j]) > tolerance) continue;
            const std::uint32_t a = root(i), b = root(j);
            target[std::max(a, b)] = std::min(a, b);
          }
        }
      }
    }
    grid[{x, y, z}].push_back(i);
  }
  for (std::uint32_t i = 0; i < target.size(); ++i) target[i] = root(i);
  const std::size_t n = surface.points.size();
  renumber(surface, target);
  return static_cast<std::int64_t>(n - surface.points.size());
}

std::int64_t drop_collapsed(IndexedSurface& surface) {
  return filter(surface, [&](std::size_t i) {
    const Triangle& t = surface.triangles[i];
    return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
  });
}

std::int64_t drop_duplicates(IndexedSurface& surface) {
  std::vector<std::pair<Triangle, std::uint32_t>> keys(surface.triangles.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    keys[i] = {surface.triangles[i], i};
    std::sort(keys[i].first.begin(), keys[i].first.end());
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint8_t> is_copy(keys.size(), 0);
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (keys[i].first == keys[i - 1].first) is_copy[keys[i].second] = 1;
  return filter(surface, [&](std::size_t i) { return !is_copy[i]; });
}

std::int64_t flip_zero_area(IndexedSurface& surface) {
  std::vector<std::uint32_t> flat;
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i)
    if (has_zero_area(surface, surface.triangles[i])) flat.push_back(i);
  if (flat.empty()) return 0;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> edges;
  const auto link = [&](std::uint32_t i, bool add) {
    const Triangle& t = surface.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      auto& list = edges[edge_key(t[k], t[(k + 1) % 3])];
      if (add) list.push_back(i);
      else std::erase(list, i);
    }
  };
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i) link(i, true);
  std::int64_t n_removed = 0;
  bool has_flipped = true;
  while (has_flipped) {
    has_flipped = false;
    for (const std::uint32_t i : flat) {
      const Triangle t = surface.triangles[i];
      if (!has_zero_area(surface, t)) continue;
      const std::size_t k = flat_corner(surface, t);
      const std::uint32_t b = t[k], c = t[(k + 1) % 3], a = t[(k + 2) % 3];
      const auto& sharing = edges[edge_key(c, a)];
      if (sharing.size() != 2) continue;
      const std::uint32_t other = sharing[0] == i ? sharing[1] : sharing[0];
      const Triangle n = surface.triangles[other];
      std::size_t m = 0;
      while (n[m] == a || n[m] == c) ++m;
      const std::uint32_t d = n[m];
      // The neighbour is (d, p, q) with {p, q} = {a, c}; it becomes (d, p, b) and (d, b, q), in its own orientation and patch.
      const Triangle first = {d, n[(m + 1) % 3], b}, second = {d, b, n[(m + 2) % 3]};
      if (d == b || edges[edge_key(b, d)].size() > 0) continue;
      if (has_zero_area(surface, first) || has_zero_area(surface, second)) continue;
      link(i, false);
      link(other, false);
      surface.triangles[other] = first;
      surface.triangles[i] = second;
      surface.patch[i] = surface.patch[other];
      link(i, true);
      link(other, true);
      has_flipped = true;
      ++n_removed;
    }
  }
  return n_removed;
}

std::int64_t drop_unused(IndexedSurface& surface) {
  std::vector<std::uint8_t> is_used(surface.points.size(), 0);
  for (const Triangle& t : surface.triangles)
    for (const std::uint32_t v : t) is_used[v] = 1;
  std::vector<std::uint32_t> number(surface.points.size());
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (!is_used[i]) continue;
    surface.points[next] = surface.points[i];
    number[i] = next++;
  }
  const auto n_unused = static_cast<std::int64_t>(surface.points.size() - next);
  surface.points.resize(next);
  for (Triangle& t : surface.triangles)
    for (std::uint32_t& v : t) v = number[v];
  return n_unused;
}

}  // namespace sterna::surfmesh
