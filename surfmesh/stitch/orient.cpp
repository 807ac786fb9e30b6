#include "surfmesh/stitch/orient.h"

#include <algorithm>

#include "geom/base/parallel.h"
#include "geom/math/bvh.h"
#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

void flip(IndexedSurface& surface, Orientation& orientation, std::size_t t) {
  std::swap(surface.triangles[t][1], surface.triangles[t][2]);
  orientation.is_flipped[t] ^= 1;
}

/// Signed volume of each component about its first point, m^3.
std::vector<double> component_volumes(const IndexedSurface& surface, const Orientation& orientation) {
  std::vector<CompensatedSum> volume(orientation.n_components);
  std::vector<std::uint32_t> first(orientation.n_components, 0xffffffffu);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const std::uint32_t c = orientation.component[t];
    if (first[c] == 0xffffffffu) first[c] = surface.triangles[t][0];
    const auto& v = surface.triangles[t];
    volume[c].add(tet_volume(surface.points[first[c]], surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]));
  }
  std::vector<double> result;
  for (const CompensatedSum& sum : volume) result.push_back(sum.value());
  return result;
}

/// Components in which a vertex of component c lies: winding number about it of all others together, each outward, is the nesting depth.
std::vector<int> nesting_depths(const IndexedSurface& surface, const Orientation& orientation, const RunContext& context) {
  std::vector<int> depth(orientation.n_components, 0);
  if (orientation.n_components == 1) return depth;
  std::vector<Box> box(orientation.n_components);
  std::vector<std::uint32_t> vertex(orientation.n_components, 0xffffffffu);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const std::uint32_t c = orientation.component[t];
    if (vertex[c] == 0xffffffffu) vertex[c] = surface.triangles[t][0];
    for (const std::uint32_t v : surface.triangles[t]) box[c].add(surface.points[v]);
  }
  const auto contains = [](const Box& outer, const Box& inner) {
    for (std::size_t k = 0; k < 3; ++k)
      if (inner.min[k] < outer.min[k] || inner.max[k] > outer.max[k]) return false;
    return true;
  };
  for (std::uint32_t outer = 0; outer < orientation.n_components; ++outer) {
    std::vector<std::uint32_t> inside;
    for (std::uint32_t inner = 0; inner < orientation.n_components; ++inner)
      if (inner != outer && contains(box[outer], box[inner])) inside.push_back(inner);
    if (inside.empty()) continue;
    TriMesh shell;
    shell.points = Column<VertexId, Point>(surface.points);
    shell.patches.push_back({"shell", PatchKind::wall});
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      if (orientation.component[t] != outer) continue;
      const auto& v = surface.triangles[t];
      shell.triangles.push_back({VertexId(v[0]), VertexId(v[1]), VertexId(v[2])});
      shell.triangle_patch.push_back(PatchId(0));
    }
    const TriangleTree tree(shell, context);
    for (const std::uint32_t inner : inside)
      if (tree.winding_number(surface.points[vertex[inner]]) > 0.5) ++depth[inner];
  }
  return depth;
}

}  // namespace

Orientation orient_consistently(IndexedSurface& surface, const EdgeTable& edges) {
  Orientation orientation;
  const std::size_t n = surface.triangles.size();
  constexpr std::uint32_t k_none = 0xffffffffu;
  struct Link {
    std::uint32_t other = k_none;
    std::uint8_t is_same_sense = 0;
  };
  std::vector<std::array<Link, 3>> links(n);
  std::vector<std::uint8_t> n_links(n, 0);
  edges.for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() != 2) return;
    const std::uint8_t same = uses[0].is_forward == uses[1].is_forward ? 1 : 0;
    for (std::size_t k = 0; k < 2; ++k) links[uses[k].triangle][n_links[uses[k].triangle]++] = {uses[1 - k].triangle, same};
  });
  orientation.component.assign(n, k_none);
  orientation.is_flipped.assign(n, 0);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t seed = 0; seed < n; ++seed) {
    if (orientation.component[seed] != k_none) continue;
    orientation.component[seed] = orientation.n_components;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::uint8_t k = 0; k < n_links[t]; ++k) {
        const auto [other, same] = links[t][k];
        if (orientation.component[other] != k_none) continue;
        orientation.component[other] = orientation.n_components;
        orientation.is_flipped[other] = orientation.is_flipped[t] ^ same;
        stack.push_back(other);
      }
    }
    ++orientation.n_components;
  }
  edges.for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() != 2) return;
    const auto sense = [&](const EdgeUse& use) { return use.is_forward ^ orientation.is_flipped[use.triangle]; };
    if (sense(uses[0]) == sense(uses[1])) orientation.conflicts.push_back(uses[0]);
  });
  for (std::size_t t = 0; t < n; ++t)
    if (orientation.is_flipped[t]) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
  return orientation;
}

std::int64_t orient_outward(IndexedSurface& surface, Orientation& orientation, const RunContext& context) {
  const std::vector<double> volume = component_volumes(surface, orientation);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (volume[orientation.component[t]] < 0.0) flip(surface, orientation, t);
  const std::vector<int> depth = nesting_depths(surface, orientation, context);
  std::size_t next = 0;
  const std::size_t n = surface.triangles.size();
  for (std::size_t t = 0; t < n; ++t) {
    if (depth[orientation.component[t]] > 0) continue;
    surface.triangles[next] = surface.triangles[t];
    surface.patch[next] = surface.patch[t];
    orientation.component[next] = orientation.component[t];
    orientation.is_flipped[next] = orientation.is_flipped[t];
    ++next;
  }
  surface.triangles.resize(next);
  surface.patch.resize(next);
  orientation.component.resize(next);
  orientation.is_flipped.resize(next);
  orientation.n_components = static_cast<std::uint32_t>(std::count(depth.begin(), depth.end(), 0));
  return static_cast<std::int64_t>(n - next);
}

void orient_open_outward(IndexedSurface& surface, Orientation& orientation) {
  Vec3 center;
  double area = 0.0;
  for (const auto& v : surface.triangles) {
    const double a = triangle_area(surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]);
    center += (a / 3.0) * (surface.points[v[0]] + surface.points[v[1]] + surface.points[v[2]]);
    area += a;
  }
  if (area > 0.0) center = center / area;
  std::vector<double> flux(orientation.n_components, 0.0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& v = surface.triangles[t];
    flux[orientation.component[t]] += tet_volume(center, surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]);
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (flux[orientation.component[t]] < 0.0) flip(surface, orientation, t);
}

}  // namespace sterna::surfmesh
