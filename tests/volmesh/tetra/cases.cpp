#include "tests/volmesh/tetra/cases.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <map>
#include <string>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "tests/support/test_shapes.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/tetra/preflight.h"

namespace sterna::test {

void Domain::add(const TriMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(points.size());
  points.insert(points.end(), mesh.points.begin(), mesh.points.end());
  for (const TriangleVertices& t : mesh.triangles) triangles.push_back({first + t[0].value(), first + t[1].value(), first + t[2].value()});
}

double Domain::volume() const {
  CompensatedSum sum;
  for (const auto& t : triangles) sum.add(-tet_volume(points[0], points[t[0]], points[t[1]], points[t[2]]));
  return sum.value();
}

volmesh::ClearProof proof_of_another_boundary() {
  Domain domain;
  domain.add(cube(1));
  return volmesh::preflight(domain.boundary(), {}, RunContext()).clear;
}

Domain domain_around(const TriMesh& wall, double farfield_radius) {
  const RunContext context;
  Domain domain;
  domain.add(wall);
  domain.add(volmesh::farfield_sphere(wall, {.farfield_radius = farfield_radius}, context));
  domain.holes = volmesh::find_cavity_points(wall, context);
  return domain;
}

TriMesh both(TriMesh a, const TriMesh& b) {
  append(a, b);
  return a;
}

TriMesh transformed(TriMesh mesh, double scale, const Vec3& shift) {
  for (Point& p : mesh.points) p = scale * p + shift;
  return mesh;
}

TriMesh inside_out(TriMesh mesh) {
  for (TriangleVertices& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriMesh box(const Vec3& lo, const Vec3& hi) {
  TriMesh mesh;
  const PatchId patch = mesh.patches.push_back({"box", PatchKind::wall});
  for (unsigned i = 0; i < 8; ++i) mesh.points.push_back({(i & 1 ? hi : lo).x, (i & 2 ? hi : lo).y, (i & 4 ? hi : lo).z});
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
    mesh.triangles.push_back({VertexId(a), VertexId(c), VertexId(d)});
  };
  quad(0, 4, 6, 2);
  quad(1, 3, 7, 5);
  quad(0, 1, 5, 4);
  quad(2, 6, 7, 3);
  quad(0, 2, 3, 1);
  quad(4, 5, 7, 6);
  mesh.triangle_patch.assign(mesh.n_triangles(), patch);
  return mesh;
}

TriMesh read_welded(const std::filesystem::path& path) {
  TriMesh mesh;
  const PatchId patch = mesh.patches.push_back({"wall", PatchKind::wall});
  std::map<std::array<double, 3>, VertexId> known;
  const auto weld = [&](const Point& p) {
    const auto [it, is_new] = known.try_emplace({p.x, p.y, p.z});
    if (is_new) it->second = mesh.points.push_back(p);
    return it->second;
  };
  const auto add = [&](const std::array<Point, 3>& p) {
    const TriangleVertices t = {weld(p[0]), weld(p[1]), weld(p[2])};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
  };
  std::ifstream file(path);
  std::string word;
  std::array<Point, 3> corner;
  if (path.extension() == ".off") {
    std::size_t n_points = 0, n_triangles = 0, n_edges = 0, n = 0;
    file >> word >> n_points >> n_triangles >> n_edges;
    std::vector<Point> points(n_points);
    for (Point& p : points) file >> p.x >> p.y >> p.z;
    for (std::size_t t = 0, v = 0; t < n_triangles && file >> n; ++t) {
      for (std::size_t k = 0; k < 3; ++k) corner[k] = file >> v ? points.at(v) : Point{};
      add(corner);
    }
  } else {
    for (std::size_t k = 0; file >> word;) {
      if (word != "vertex") continue;
      file >> corner[k].x >> corner[k].y >> corner[k].z;
      if (++k < 3) continue;
      add(corner);
      k = 0;
    }
  }
  mesh.triangle_patch.assign(mesh.n_triangles(), patch);
  return mesh;
}

void expect_tiling(const Domain& domain, const volmesh::TetraResult& result) {
  std::vector<Vec3> points = domain.points;
  points.insert(points.end(), result.new_points.begin(), result.new_points.end());
  // Oriented faces, rotated so that the lowest node comes first; each must occur with its reverse exactly once.
  std::map<std::array<std::uint32_t, 3>, int> count;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    while (a > b || a > c) std::tie(a, b, c) = std::tuple(b, c, a);
    ++count[{a, b, c}];
  };
  CompensatedSum volume;
  ASSERT_FALSE(result.tetrahedra.empty());
  for (const auto& [a, b, c, d] : result.tetrahedra) {
    ASSERT_LT(std::max({a, b, c, d}), points.size());
    add(a, c, b);
    add(a, b, d);
    add(b, c, d);
    add(c, a, d);
    volume.add(tet_volume(points[a], points[b], points[c], points[d]));
  }
  for (const auto& t : domain.triangles) add(t[0], t[1], t[2]);
  std::size_t n_bad = 0;
  for (const auto& [face, n] : count) {
    const auto reverse = count.find({face[0], face[2], face[1]});
    n_bad += n != 1 || reverse == count.end() || reverse->second != 1;
  }
  EXPECT_EQ(n_bad, 0u);
  // The tolerance covers the sum of the rounding errors of the tets; there is no cancellation, since all volumes are positive.
  EXPECT_NEAR(volume.value() / domain.volume(), 1.0, 1e-11);
}

bool has_no_children() { return waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD; }

}  // namespace sterna::test
