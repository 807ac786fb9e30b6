#include "surfmesh/stitch/edges.h"

#include <numeric>
#include <tuple>

#include "geom/base/parallel.h"

namespace sterna::surfmesh {

EdgeTable::EdgeTable(const IndexedSurface& surface, const RunContext& context) : uses_(3 * surface.triangles.size()) {
  parallel_for(context, surface.triangles.size(), [&](std::size_t i) {
    const auto& t = surface.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      uses_[3 * i + k] = {std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(i), from < to ? std::uint8_t{1} : std::uint8_t{0}};
    }
  });
  parallel_sort(context, uses_, [](const EdgeUse& x, const EdgeUse& y) {
    return std::tie(x.a, x.b, x.triangle) < std::tie(y.a, y.b, y.triangle);
  });
}

EdgeDefects find_defects(const EdgeTable& edges) {
  EdgeDefects defects;
  edges.for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() == 1) defects.boundary.push_back(uses[0]);
    if (uses.size() > 2) defects.crowded.push_back(uses[0]);
  });
  return defects;
}

std::vector<std::uint32_t> vertices_with_several_fans(const IndexedSurface& surface, const EdgeTable& edges) {
  // Corners of one vertex that share an edge there belong to one fan: union-find over corners.
  std::vector<std::uint32_t> root(3 * surface.triangles.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t c) {
    while (root[c] != c) c = root[c] = root[root[c]];
    return c;
  };
  const auto corner = [&](std::uint32_t triangle, std::uint32_t vertex) {
    const auto& t = surface.triangles[triangle];
    return 3 * triangle + (t[0] == vertex ? 0u : t[1] == vertex ? 1u : 2u);
  };
  edges.for_each([&](std::span<const EdgeUse> uses) {
    for (std::size_t i = 1; i < uses.size(); ++i) {
      for (const std::uint32_t v : {uses[0].a, uses[0].b}) {
        const std::uint32_t x = find(corner(uses[0].triangle, v)), y = find(corner(uses[i].triangle, v));
        root[std::max(x, y)] = std::min(x, y);
      }
    }
  });
  constexpr std::uint32_t k_none = 0xffffffffu;
  std::vector<std::uint32_t> fan(surface.points.size(), k_none);
  std::vector<std::uint8_t> is_bad(surface.points.size(), 0);
  for (std::uint32_t c = 0; c < root.size(); ++c) {
    const std::uint32_t v = surface.triangles[c / 3][c % 3];
    const std::uint32_t r = find(c);
    if (fan[v] == k_none) fan[v] = r;
    else if (fan[v] != r) is_bad[v] = 1;
  }
  std::vector<std::uint32_t> bad;
  for (std::uint32_t v = 0; v < is_bad.size(); ++v)
    if (is_bad[v]) bad.push_back(v);
  return bad;
}

}  // namespace sterna::surfmesh
