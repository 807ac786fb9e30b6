// Whether anything refines what a body leaves behind.
#pragma once

#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// A body in a farfield of our own without any source or wake sheet: nothing but the growth of tetrahedra resolves its wake. Not of tunnels and of bodies with
/// engines, whose flow is not around them.
bool has_bare_wake(const TriMesh& surface, const MeshCase& options);

}  // namespace sterna::volmesh
