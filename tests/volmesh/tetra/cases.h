// Boundaries for the tests of the tetrahedra, and an independent check of what fills them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "geom/base/error.h"
#include "geom/mesh/tri_mesh.h"
#include "tests/support/error_of.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::test {

/// Owns what a TetraBoundary refers to.
struct Domain {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Vec3> holes;
  volmesh::TetraBoundary boundary() const { return {points, triangles, holes}; }
  void add(const TriMesh& mesh);
  /// Volume of the domain by the divergence theorem, m^3.
  double volume() const;
};

/// The wall (inner boundary as it is) in its farfield sphere, cavities found automatically.
Domain domain_around(const TriMesh& wall, double farfield_radius = k_automatic);

/// Both meshes as one, patches joined.
TriMesh both(TriMesh a, const TriMesh& b);
TriMesh transformed(TriMesh mesh, double scale, const Vec3& shift);
TriMesh inside_out(TriMesh mesh);
/// Box [lo, hi] with 12 triangles, normals outward.
TriMesh box(const Vec3& lo, const Vec3& hi);

/// OFF or ASCII STL, vertices with equal coordinates welded, triangles with equal corners dropped; so that these tests need no reader of io.
TriMesh read_welded(const std::filesystem::path& path);

/// Fails the test unless the result tiles the domain: faces counted by a map, volumes summed; nothing of verify.cpp is used.
void expect_tiling(const Domain& domain, const volmesh::TetraResult& result);

/// No child of this process is left, running or dead.
bool has_no_children();

}  // namespace sterna::test
