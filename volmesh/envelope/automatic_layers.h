// The number of layers where it is automatic.
#pragma once

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// The fewest layers with which the last cell, growing by the ratio that is asked for, is at least half as tall as a regular tetrahedron on its triangle, on
/// nine tenths of the area: of the walls that ask for the same first height and growth, and of all such walls the largest number. Patches whose number of
/// layers or total height a rule gives do not count. Where no other carries layers: the largest number that a rule gives. At least 1 where there are no walls.
/// \throws Error(bad_argument) where 1000 layers do not get as tall
/// \pre `options` are those of the member of a mesh family that is meshed (refined())
int automatic_layers(const TriMesh& surface, const MeshCase& options, const RunContext& context);

/// The options with that number where layers are automatic, which is told; else as they are.
MeshCase with_automatic_layers(const TriMesh& surface, MeshCase options, const RunContext& context);

}  // namespace sterna::volmesh
