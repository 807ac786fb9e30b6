#include "tests/support/voxels.h"

#include <algorithm>
#include <map>
#include <set>

namespace sterna::test {

TriMesh voxel_boundary(const std::array<int, 3>& n, double size, const std::function<bool(int, int, int)>& is_fluid,
                       const std::function<Patch(const Point&, const Vec3&)>& patch_of) {
  TriMesh mesh;
  std::map<std::array<int, 3>, VertexId> number;
  const auto is_inside = [&](const std::array<int, 3>& c) {
    for (std::size_t a = 0; a < 3; ++a)
      if (c[a] < 0 || c[a] >= n[a]) return false;
    return is_fluid(c[0], c[1], c[2]);
  };
  const auto vertex = [&](const std::array<int, 3>& corner) {
    const auto [at, is_new] = number.emplace(corner, VertexId{});
    if (is_new) at->second = mesh.points.push_back({size * corner[0], size * corner[1], size * corner[2]});
    return at->second;
  };
  for (int i = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < n[2]; ++k) {
        const std::array<int, 3> cell = {i, j, k};
        if (!is_inside(cell)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const int side : {0, 1}) {
            std::array<int, 3> other = cell;
            other[axis] += side == 0 ? -1 : 1;
            if (is_inside(other)) continue;
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::array<std::array<int, 3>, 4> corner{};
            for (std::size_t c = 0; c < 4; ++c) {
              corner[c] = cell;
              corner[c][axis] += side;
              if (c == 1 || c == 2) ++corner[c][u];
              if (c >= 2) ++corner[c][v];
            }
            Vec3 normal;
            normal[axis] = side == 0 ? 1.0 : -1.0;
            if (side == 1) std::swap(corner[1], corner[3]);
            Point middle;
            std::array<VertexId, 4> p;
            for (std::size_t c = 0; c < 4; ++c) {
              p[c] = vertex(corner[c]);
              middle += 0.25 * mesh.points[p[c]];
            }
            const Patch patch = patch_of(middle, normal);
            PatchId id;
            for (const PatchId known : mesh.patches.ids())
              if (mesh.patches[known] == patch) id = known;
            if (!id.is_valid()) id = mesh.patches.push_back(patch);
            const std::size_t turn = static_cast<std::size_t>(i + j + k) % 2;  // diagonals alternate
            mesh.triangles.push_back({p[turn], p[turn + 1], p[turn + 2]});
            mesh.triangles.push_back({p[turn], p[turn + 2], p[(turn + 3) % 4]});
            mesh.triangle_patch.push_back(id);
            mesh.triangle_patch.push_back(id);
          }
        }
      }
  return mesh;
}

TriMesh chain_of_cubes(int n) {
  const std::set<std::array<int, 3>> solid = {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 0}};
  TriMesh mesh = voxel_boundary(
      {2 * n, 2 * n, 2 * n}, 1.0 / n,
      [&](int i, int j, int k) {
        return solid.contains({i / n, j / n, k / n});
      },
      [](const Point&, const Vec3&) {
        return Patch{"body", PatchKind::wall};
      });
  for (TriangleVertices& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace sterna::test
