// Private to volmesh/domain: planes that bodies and their outer boundary end on, as patches.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/envelope/constrain_rims.h"

namespace sterna::volmesh {

/// The planes of constraints_of_rims().
std::vector<EndPlane> end_planes_of(const Constraints& rims);

/// Signed volume of each component, as flux of a coordinate along itself for which the planes count nothing: positive for bodies with normals out of them, also
/// where they are open in the planes.
/// \throws Error(open_surface) when there are two planes across each axis
std::vector<double> volumes_of(const TriMesh& mesh, const Components& components, std::span<const EndPlane> ends);

/// Closes `mesh` by one patch per plane, between the rims that lie in it; patches[i] is that of ends[i]. Where two planes meet, the line between rims is
/// divided with lengths that grow from rim to rim, up to the lesser of the planes' `edges` (m; automatic: no limit), and both planes share its new vertices;
/// they have no other ones. Long thin triangles; normals into the fluid.
/// \pre rims lie in their planes to the bit
/// \throws Error(open_surface) with places where rims are no border between inside and outside, and where three planes meet
void fill_ends(TriMesh& mesh, std::span<const EndPlane> ends, std::span<const Patch> patches, std::span<const double> edges, const RunContext& context);

}  // namespace sterna::volmesh
