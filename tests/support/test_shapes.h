// Small exact shapes for tests.
#pragma once

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

/// Returns an axis-parallel cube [0, 1]^3, each face split into 2 n^2 triangles, normals outward, one patch "cube".
TriMesh cube(int n = 1);
/// Returns an icosahedral sphere about the origin, 20 f^2 triangles, normals outward, one patch "sphere".
TriMesh sphere(int f, double radius = 1.0);

/// Returns the enclosed volume, positive if the normals point outward, m^3.
double volume_of(const TriMesh& mesh);

}  // namespace sterna::test
