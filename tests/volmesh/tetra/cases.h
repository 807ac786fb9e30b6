// Boundaries for the tests of the tetrahedra, and an independent check of their fillings.
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

/// Owns the data to which a TetraBoundary refers.
struct Domain {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Vec3> holes;
  volmesh::TetraBoundary boundary() const& { return {points, triangles, holes}; }
  volmesh::TetraBoundary boundary() const&& = delete;
  void add(const TriMesh& mesh);
  /// Volume of the domain by the divergence theorem, m^3.
  double volume() const;
};

/// Returns the proof of the pre-flight for a boundary without crossings. A test can give it to a boundary that crosses itself.
volmesh::ClearProof proof_of_another_boundary();

/// Returns the domain between the unchanged wall and its farfield sphere; cavities are found automatically.
Domain domain_around(const TriMesh& wall, double farfield_radius = k_automatic);

/// Returns both meshes as one, with joined patches.
TriMesh both(TriMesh a, const TriMesh& b);
TriMesh transformed(TriMesh mesh, double scale, const Vec3& shift);
TriMesh inside_out(TriMesh mesh);
/// Box [lo, hi] with 12 triangles, normals outward.
TriMesh box(const Vec3& lo, const Vec3& hi);

/// Reads OFF or ASCII STL, welds vertices with equal coordinates, and drops triangles with equal corners, so that these tests need no reader of io.
TriMesh read_welded(const std::filesystem::path& path);

/// Fails the test unless the result tiles the domain. Counts faces in a map and sums volumes, without using verify.cpp.
void expect_tiling(const Domain& domain, const volmesh::TetraResult& result);

/// Returns true if this process has no child left, running or dead.
bool has_no_children();

}  // namespace sterna::test
