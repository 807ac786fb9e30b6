// Halves of hybrid meshes: layers that end on a plane with boundary quads, beside tetrahedra that end there with triangles.
#pragma once

#include "geom/mesh/hybrid_mesh.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::test {

struct HalfShellOptions {
  ShellOptions shell;
  bool has_collapsed_rim = false;  ///< a line of the rim, another with its neighbour along the rim, and another with one inside have no height
};

/// The half y >= 0 of sphere_shell(f): patches "sphere" (wall), "farfield", and "symmetry" at y = 0 exactly.
/// \pre f >= 4
HybridMesh half_sphere_shell(int f, const HalfShellOptions& options = {});

/// The same with a patch of each kind: the plane y = 0 is parted by quadrants into "symmetry", "slip_wall", "inflow", "outflow", and "disc" (interface) is a
/// fan of faces between two of them. All of these have quads, and with a collapsed rim triangles beside collapsed lines, too.
HybridMesh half_shell_of_all_kinds(int f, const HalfShellOptions& options = {});

/// Turned about the origin by a third of a full turn and a bit about an axis that is none of the coordinates', then moved.
HybridMesh turned(HybridMesh mesh, const Vec3& offset = {});

}  // namespace sterna::test
