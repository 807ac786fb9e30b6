// Closed bodies for the tests of unions, and the requirements for every union.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "geom/base/error.h"
#include "geom/boolean/union_meshes.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"
#include "tests/support/test_shapes.h"

namespace sterna::test {

inline TriMesh named(TriMesh mesh, const std::string& name) {
  mesh.patches = {Patch{.name = name}};
  return mesh;
}

inline TriMesh shifted(TriMesh mesh, const Vec3& by, double scale = 1.0) {
  for (Point& p : mesh.points) p = scale * p + by;
  return mesh;
}

inline TriMesh stretched(TriMesh mesh, const Vec3& scale) {
  for (Point& p : mesh.points) p = {p.x * scale.x, p.y * scale.y, p.z * scale.z};
  return mesh;
}

/// Returns the mesh rotated about z, then about x (rad).
inline TriMesh turned(TriMesh mesh, double about_z, double about_x) {
  for (Point& p : mesh.points) {
    p = {std::cos(about_z) * p.x - std::sin(about_z) * p.y, std::sin(about_z) * p.x + std::cos(about_z) * p.y, p.z};
    p = {p.x, std::cos(about_x) * p.y - std::sin(about_x) * p.z, std::sin(about_x) * p.y + std::cos(about_x) * p.z};
  }
  return mesh;
}

/// Returns a cylinder along x from 0 to `length`, with n facets around, m rings, and caps of triangle fans.
inline TriMesh cylinder(double radius, double length, int n, int m) {
  TriMesh mesh;
  mesh.patches = {Patch{.name = "cylinder"}};
  const auto at = [&](int ring, int i) { return VertexId(ring * n + (i % n)); };
  for (int ring = 0; ring <= m; ++ring)
    for (int i = 0; i < n; ++i) {
      const double a = 2.0 * std::numbers::pi * i / n;
      mesh.points.push_back({length * ring / m, radius * std::cos(a), radius * std::sin(a)});
    }
  const VertexId front = mesh.points.push_back({0, 0, 0}), back = mesh.points.push_back({length, 0, 0});
  for (int i = 0; i < n; ++i) {
    for (int ring = 0; ring < m; ++ring) {
      mesh.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i)});
      mesh.triangles.push_back({at(ring + 1, i), at(ring, i + 1), at(ring + 1, i + 1)});
    }
    mesh.triangles.push_back({front, at(0, i + 1), at(0, i)});
    mesh.triangles.push_back({back, at(m, i), at(m, i + 1)});
  }
  mesh.triangle_patch.assign(mesh.n_triangles(), PatchId(0));
  return mesh;
}

inline double volume(const TriMesh& mesh) {
  double sum = 0.0;
  const Vec3 origin = bounding_box(mesh).center();
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    sum += tet_volume(origin, c[0], c[1], c[2]);
  }
  return sum;
}

inline RunContext quiet(int threads = 2) { return RunContext({.threads = threads}); }

/// Checks the postconditions of the contract.
inline void expect_wall(const TriMesh& mesh) {
  const RunContext context = quiet();
  const Topology topology(mesh, context);  // throws when not manifold or not consistently oriented
  EXPECT_EQ(topology.n_boundary_halfedges(), 0u);
  for (std::size_t v = 0; v < mesh.n_vertices(); ++v) ASSERT_FALSE(topology.outgoing(VertexId(std::uint64_t{v})).empty()) << "vertex " << v << " is unused";
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  EXPECT_EQ(find_crossings(mesh.points.raw(), triangles, context).total, 0);
  EXPECT_GT(volume(mesh), 0.0);
  ASSERT_EQ(mesh.triangle_patch.size(), mesh.n_triangles());
  std::set<std::string> names;
  std::vector<char> is_used(mesh.patches.size(), 0);
  for (const PatchId p : mesh.triangle_patch) is_used.at(p.index()) = 1;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    EXPECT_TRUE(names.insert(mesh.patches.raw()[p].name).second) << mesh.patches.raw()[p].name;
    EXPECT_TRUE(is_used[p]) << mesh.patches.raw()[p].name;
  }
}

/// Unites named bodies; the result must be a wall.
inline UnionResult unite(const std::vector<TriMesh>& bodies, const UnionOptions& options = {}, int threads = 2) {
  std::vector<UnionPart> parts;
  for (std::size_t i = 0; i < bodies.size(); ++i) parts.push_back({std::string(1, static_cast<char>('a' + i)), bodies[i]});
  UnionResult result = unite_meshes(parts, options, quiet(threads));
  expect_wall(result.mesh);
  return result;
}

inline ErrorInfo union_error(const std::vector<TriMesh>& bodies) {
  try {
    unite(bodies);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = error.what();  // the whole message, for tests of the wording
    return info;
  }
  ADD_FAILURE() << "the union was made";
  return {};
}

}  // namespace sterna::test
