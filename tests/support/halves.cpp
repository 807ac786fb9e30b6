#include "tests/support/halves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace sterna::test {
namespace {

constexpr double k_snap_share = 1.0 / 3.0;

/// Removes vertices that no triangle uses.
TriMesh compacted(const TriMesh& mesh) {
  TriMesh result;
  result.patches = mesh.patches;
  result.triangle_patch = mesh.triangle_patch;
  Column<VertexId, VertexId> number(mesh.n_vertices());
  for (const TriangleVertices& t : mesh.triangles) {
    TriangleVertices mapped;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!number[t[k]].is_valid()) number[t[k]] = result.points.push_back(mesh.points[t[k]]);
      mapped[k] = number[t[k]];
    }
    result.triangles.push_back(mapped);
  }
  return result;
}

}  // namespace

TriMesh cut_off(const TriMesh& mesh, std::size_t axis, double value) {
  TriMesh result = mesh;
  result.triangles.clear();
  result.triangle_patch.clear();
  std::vector<double> shortest(mesh.n_vertices(), 1e300);
  for (const TriangleVertices& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      for (const VertexId v : {t[k], t[(k + 1) % 3]})
        shortest[v.index()] = std::min(shortest[v.index()], distance(mesh.points[t[k]], mesh.points[t[(k + 1) % 3]]));
  for (const VertexId v : mesh.points.ids())
    if (std::abs(mesh.points[v][axis] - value) < k_snap_share * shortest[v.index()]) result.points[v][axis] = value;
  std::map<std::pair<VertexId, VertexId>, VertexId> cuts;
  const auto cut = [&](VertexId a, VertexId b) {
    if (b < a) std::swap(a, b);
    const auto [entry, is_new] = cuts.try_emplace({a, b});
    if (is_new) {
      const Point p = result.points[a], q = result.points[b];
      Point middle = p + ((value - p[axis]) / (q[axis] - p[axis])) * (q - p);
      middle[axis] = value;
      entry->second = result.points.push_back(middle);
    }
    return entry->second;
  };
  for (const TriangleId id : mesh.triangles.ids()) {
    const TriangleVertices& t = mesh.triangles[id];
    std::vector<VertexId> polygon;
    bool has_inside = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = t[k], b = t[(k + 1) % 3];
      const double x = result.points[a][axis] - value, y = result.points[b][axis] - value;
      has_inside = has_inside || x > 0.0;
      if (x >= 0.0) polygon.push_back(a);
      if (x * y < 0.0) polygon.push_back(cut(a, b));
    }
    if (!has_inside) continue;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      result.triangles.push_back({polygon[a], polygon[b], polygon[c]});
      result.triangle_patch.push_back(mesh.triangle_patch[id]);
    };
    if (polygon.size() == 3) add(0, 1, 2);
    if (polygon.size() != 4) continue;
    const auto length = [&](std::size_t a, std::size_t b) { return distance(result.points[polygon[a]], result.points[polygon[b]]); };
    if (length(0, 2) <= length(1, 3)) {
      add(0, 1, 2);
      add(0, 2, 3);
    } else {
      add(0, 1, 3);
      add(1, 2, 3);
    }
  }
  return compacted(result);
}

TriMesh with_mirror_image(const TriMesh& half, std::size_t axis, double value) {
  TriMesh whole = half;
  Column<VertexId, VertexId> image(half.n_vertices());
  for (const VertexId v : half.points.ids()) {
    Point p = half.points[v];
    if (p[axis] == value) {
      image[v] = v;
      continue;
    }
    p[axis] = 2.0 * value - p[axis];
    image[v] = whole.points.push_back(p);
  }
  for (const TriangleId id : half.triangles.ids()) {
    const TriangleVertices& t = half.triangles[id];
    whole.triangles.push_back({image[t[0]], image[t[2]], image[t[1]]});
    whole.triangle_patch.push_back(half.triangle_patch[id]);
  }
  return whole;
}

}  // namespace sterna::test
