// A cylinder of long strips along y: a typical user wall of adjacent needles (sliver triangles).
#pragma once

#include <cmath>
#include <cstdint>

#include "geom/mesh/tri_mesh.h"
#include "tests/support/test_constants.h"

namespace sterna::volmesh {

/// Makes a cylinder of radius 1 m, from y = 0 to `length` (m), with `n` strips of two triangles. Patches: "side" and "end" (y = length), and "root" (y = 0)
/// unless `is_open`. Normals point outwards.
inline TriMesh long_strips(int n, double length, bool is_open = false) {
  TriMesh mesh;
  mesh.patches = Column<PatchId, Patch>{{"side", PatchKind::wall}, {"end", PatchKind::wall}, {"root", PatchKind::wall}};
  if (is_open) mesh.patches.raw().pop_back();
  const auto vertex = [&](int i, int end) { return VertexId(static_cast<std::uint64_t>(2 * ((i + n) % n) + end)); };
  for (int i = 0; i < n; ++i)
    for (const double y : {0.0, length}) {
      const double angle = 2.0 * test::k_pi * i / n;
      mesh.points.push_back({std::sin(angle), y, std::cos(angle)});
    }
  const VertexId root = is_open ? VertexId() : mesh.points.push_back({0, 0, 0});
  const VertexId end = mesh.points.push_back({0, length, 0});
  const auto add = [&](VertexId a, VertexId b, VertexId c, std::uint64_t patch) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangle_patch.push_back(PatchId(patch));
  };
  for (int i = 0; i < n; ++i) {
    add(vertex(i, 0), vertex(i + 1, 0), vertex(i + 1, 1), 0);
    add(vertex(i, 0), vertex(i + 1, 1), vertex(i, 1), 0);
    add(vertex(i, 1), vertex(i + 1, 1), end, 1);
    if (!is_open) add(vertex(i + 1, 0), vertex(i, 0), root, 2);
  }
  return mesh;
}

}  // namespace sterna::volmesh
