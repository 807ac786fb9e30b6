// Private to volmesh/domain: planes in which bodies and their outer boundary end, as patches.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/envelope/constrain_rims.h"

namespace sterna::volmesh {

/// Returns the planes of constraints_of_rims().
std::vector<EndPlane> end_planes_of(const Constraints& rims);

/// Signed volume of each component, as the flux of a coordinate along itself, chosen so that the planes contribute nothing: positive for bodies with outward
/// normals, also if they are open in the planes.
/// \throws Error(open_surface) if there are two planes across each axis
std::vector<double> volumes_of(const TriMesh& mesh, const Components& components, std::span<const EndPlane> ends);

/// Closes `mesh` by one patch per plane, between the open boundaries that lie in it; patches[i] belongs to ends[i]. Where two planes meet, the line between
/// open boundaries is divided with lengths that grow from both ends, up to the lesser of the planes' `edges` (m; automatic: no limit), and both planes share
/// its new vertices; they have no other new vertices. The result has long thin triangles, with normals into the fluid.
/// \pre open-boundary vertices lie bit-exactly in their planes
/// \throws Error(open_surface) with locations where open boundaries do not separate inside and outside, and where three planes meet
void fill_ends(TriMesh& mesh, std::span<const EndPlane> ends, std::span<const Patch> patches, std::span<const double> edges, const RunContext& context);

}  // namespace sterna::volmesh
