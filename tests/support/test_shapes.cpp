#include "tests/support/test_shapes.h"

#include <map>
#include <tuple>

#include "geom/math/measures.h"

namespace sterna::test {
namespace {

VertexId vertex_at(TriMesh& mesh, std::map<std::tuple<double, double, double>, VertexId>& known, const Point& p) {
  const auto [it, is_new] = known.try_emplace({p.x, p.y, p.z});
  if (is_new) it->second = mesh.points.push_back(p);
  return it->second;
}

void add_triangle(TriMesh& mesh, VertexId a, VertexId b, VertexId c) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangle_patch.push_back(PatchId(0));
}

}  // namespace

TriMesh cube(int n) {
  TriMesh mesh;
  mesh.patches.push_back({"cube", PatchKind::wall});
  std::map<std::tuple<double, double, double>, VertexId> known;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const auto corner = [&](int i, int j) {
        Point p;
        p[axis] = side;
        p[(axis + 1) % 3] = static_cast<double>(i) / n;
        p[(axis + 2) % 3] = static_cast<double>(j) / n;
        return vertex_at(mesh, known, p);
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const VertexId a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
          if (side == 1) {
            add_triangle(mesh, a, b, c);
            add_triangle(mesh, a, c, d);
          } else {
            add_triangle(mesh, a, c, b);
            add_triangle(mesh, a, d, c);
          }
        }
      }
    }
  }
  return mesh;
}

TriMesh sphere(int f, double radius) {
  const double g = (1.0 + std::sqrt(5.0)) / 2.0;
  const std::array<Vec3, 12> v = {
      {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}}};
  const std::array<std::array<int, 3>, 20> faces = {{{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                                     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                                     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  TriMesh mesh;
  mesh.patches.push_back({"sphere", PatchKind::wall});
  std::map<std::tuple<long, long, long>, VertexId> known;
  for (const auto& face : faces) {
    std::vector<std::vector<VertexId>> rows(static_cast<std::size_t>(f) + 1);
    for (int i = 0; i <= f; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Vec3 p = v[static_cast<std::size_t>(face[0])] * ((f - i) / static_cast<double>(f)) +
                       v[static_cast<std::size_t>(face[1])] * ((i - j) / static_cast<double>(f)) +
                       v[static_cast<std::size_t>(face[2])] * (j / static_cast<double>(f));
        const auto key = std::tuple{std::lround(p.x * 1e9), std::lround(p.y * 1e9), std::lround(p.z * 1e9)};
        const auto [it, is_new] = known.try_emplace(key);
        if (is_new) it->second = mesh.points.push_back(radius * normalized(p));
        rows[static_cast<std::size_t>(i)].push_back(it->second);
      }
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(f); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        add_triangle(mesh, rows[i][j], rows[i + 1][j], rows[i + 1][j + 1]);
        if (j < i) add_triangle(mesh, rows[i][j], rows[i + 1][j + 1], rows[i][j + 1]);
      }
    }
  }
  return mesh;
}

double volume_of(const TriMesh& mesh) {
  double sum = 0.0;
  for (const TriangleVertices& v : mesh.triangles) sum += tet_volume(mesh.points[VertexId(0)], mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]);
  return sum;
}

}  // namespace sterna::test
