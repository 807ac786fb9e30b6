// Halves of hybrid meshes: layers that end on a plane with boundary quads, beside tetrahedra that end there with triangles.
#pragma once

#include "geom/mesh/hybrid_mesh.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::test {

struct HalfShellOptions {
  ShellOptions shell;
  bool has_collapsed_border =
      false;  ///< zero height: a growth line on the boundary, another with its neighbour on the boundary, another with an inner neighbour
};

/// Returns the half y >= 0 of sphere_shell(f): patches "sphere" (wall), "farfield", and "symmetry" at exactly y = 0.
/// \pre f >= 4
HybridMesh half_sphere_shell(int f, const HalfShellOptions& options = {});

/// Returns half_sphere_shell() with a patch of each kind. The plane y = 0 is split by quadrants into "symmetry", "slip_wall", "inflow", "outflow"; "disc"
/// (interface) is a fan of faces between two of them. All of these patches have quads, and with a collapsed boundary also triangles beside collapsed growth
/// lines.
HybridMesh half_shell_of_all_kinds(int f, const HalfShellOptions& options = {});

/// Returns the mesh rotated about the origin by slightly more than a third of a turn, about an axis oblique to the coordinate axes, then translated.
HybridMesh turned(HybridMesh mesh, const Vec3& offset = {});

}  // namespace sterna::test
