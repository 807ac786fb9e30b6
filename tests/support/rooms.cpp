#include "tests/support/rooms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "tests/support/voxels.h"

namespace sterna::test {
namespace {

using Location = std::array<int, 3>;

/// Builds a mesh from vertices at grid positions and patches by name.
class Builder {
 public:
  TriMesh mesh;

  VertexId vertex(const Location& location, const Point& p) {
    const auto [found, is_new] = vertices_.try_emplace(location, VertexId(mesh.n_vertices()));
    if (is_new) mesh.points.push_back(p);
    return found->second;
  }
  void triangle(VertexId a, VertexId b, VertexId c, const std::string& patch) {
    const auto [found, is_new] = patches_.try_emplace(patch, PatchId(mesh.patches.size()));
    if (is_new) mesh.patches.push_back({patch, PatchKind::wall});
    mesh.triangles.push_back({a, b, c});
    mesh.triangle_patch.push_back(found->second);
  }
  /// Adds a square, counter-clockwise seen from the fluid; the diagonal alternates.
  void square(const std::array<VertexId, 4>& v, bool is_odd, const std::string& patch) {
    const std::size_t first = is_odd ? 0 : 1;
    triangle(v[first], v[first + 1], v[first + 2], patch);
    triangle(v[first], v[first + 2], v[(first + 3) % 4], patch);
  }

 private:
  std::map<Location, VertexId> vertices_;
  std::map<std::string, PatchId> patches_;
};

}  // namespace

TriMesh cube_room(int n) {
  return voxel_boundary(
      {n, n, n}, 1.0 / n, [](int, int, int) { return true; },
      [](const Point&, const Vec3& normal) {
        return Patch{std::string(normal.x != 0 ? "x" : normal.y != 0 ? "y" : "z") + (normal.x + normal.y + normal.z > 0 ? "0" : "1"), PatchKind::wall};
      });
}

// Grid of the triangle: i steps along the lower side, j along the upper side, i + j <= n; k along y.
TriMesh wedge_room(double angle, int n, double length) {
  Builder builder;
  const int m = std::max(1, static_cast<int>(std::lround(n * length)));
  const Vec3 lower = {1.0 / n, 0, 0}, upper = Vec3{std::cos(angle), 0, std::sin(angle)} / static_cast<double>(n), along = {0, length / m, 0};
  const auto at = [&](int i, int j, int k) {
    return builder.vertex({i, j, k}, static_cast<double>(i) * lower + static_cast<double>(j) * upper + static_cast<double>(k) * along);
  };
  // y points away from a viewer who sees x to the right and z up.
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      const bool has_second = i + j + 2 <= n;
      builder.triangle(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j, 0), "left");
      if (has_second) builder.triangle(at(i + 1, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), "left");
      builder.triangle(at(i, j, m), at(i + 1, j, m), at(i, j + 1, m), "right");
      if (has_second) builder.triangle(at(i + 1, j, m), at(i + 1, j + 1, m), at(i, j + 1, m), "right");
    }
  for (int k = 0; k < m; ++k)
    for (int i = 0; i < n; ++i) {
      const bool is_odd = (i + k) % 2 != 0;
      builder.square({at(i, 0, k), at(i + 1, 0, k), at(i + 1, 0, k + 1), at(i, 0, k + 1)}, is_odd, "lower");
      builder.square({at(0, i + 1, k), at(0, i, k), at(0, i, k + 1), at(0, i + 1, k + 1)}, is_odd, "upper");
      builder.square({at(n - i, i, k), at(n - i - 1, i + 1, k), at(n - i - 1, i + 1, k + 1), at(n - i, i, k + 1)}, is_odd, "back");
    }
  return std::move(builder.mesh);
}

}  // namespace sterna::test
