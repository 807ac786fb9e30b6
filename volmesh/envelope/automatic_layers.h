// Automatic number of layers.
#pragma once

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// Returns the smallest number of layers with which the last cell is high enough: with the requested growth it must be at least half as tall as a regular
/// tetrahedron on its triangle, on nine tenths of the area. The number is computed for each set of walls with the same requested first height and growth, and
/// the largest one is returned. Patches whose number of layers or total height is given by a rule are ignored. If no other patch carries layers, the result is
/// the largest number given by a rule. If there are no walls, it is 1.
/// \throws Error(bad_argument) if 1000 layers do not reach this height
/// \pre `options` belong to the member of a mesh family that is meshed (refined())
int automatic_layers(const TriMesh& surface, const MeshCase& options, const RunContext& context);

/// If the number of layers is automatic, returns the options with the computed number, and logs it. Otherwise returns the options unchanged.
MeshCase with_automatic_layers(const TriMesh& surface, MeshCase options, const RunContext& context);

}  // namespace sterna::volmesh
