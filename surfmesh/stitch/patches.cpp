#include "surfmesh/stitch/patches.h"

#include <cctype>
#include <numeric>

#include "geom/math/measures.h"

namespace sterna::surfmesh {

std::string clean_patch_name(const std::string& name, const std::string& if_empty) {
  std::string clean;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    clean += (u < 128 && std::isalnum(u)) || c == '_' || c == '.' || c == '-' ? c : '_';
  }
  while (!clean.empty() && clean.back() == '_') clean.pop_back();
  const std::size_t start = clean.find_first_not_of('_');
  clean = start == std::string::npos ? "" : clean.substr(start);
  if (clean.empty()) clean = if_empty;
  if (std::isdigit(static_cast<unsigned char>(clean.front()))) clean = "patch_" + clean;
  return clean;
}

std::uint32_t split_by_angle(IndexedSurface& surface, const EdgeTable& edges, double angle, std::vector<std::uint32_t>& parent) {
  std::vector<std::uint32_t> root(surface.triangles.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  const auto normal = [&](std::uint32_t t) {
    const auto& v = surface.triangles[t];
    return area_vector(surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]);
  };
  edges.for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() != 2) return;
    const std::uint32_t a = uses[0].triangle, b = uses[1].triangle;
    if (surface.patch[a] != surface.patch[b] || angle_between(normal(a), normal(b)) > angle) return;
    const std::uint32_t x = find(a), y = find(b);
    root[std::max(x, y)] = std::min(x, y);
  });
  std::vector<std::uint32_t> number(root.size(), 0xffffffffu);
  std::vector<std::uint32_t> region(root.size());
  parent.clear();
  for (std::uint32_t t = 0; t < root.size(); ++t) {
    std::uint32_t& n = number[find(t)];
    if (n == 0xffffffffu) {
      n = static_cast<std::uint32_t>(parent.size());
      parent.push_back(surface.patch[t]);
    }
    region[t] = n;
  }
  surface.patch = std::move(region);
  return static_cast<std::uint32_t>(parent.size());
}

}  // namespace sterna::surfmesh
