// Private to volmesh/domain: closes the planes in which bodies and their outer boundary end by patches.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/envelope/constrain_borders.h"

namespace sterna::volmesh {

/// Returns the planes found by constraints_of_borders().
std::vector<EndPlane> end_planes_of(const Constraints& borders);

/// Returns the signed volume of each component, as the flux of one coordinate along its axis. The coordinate is chosen so that the planes contribute nothing.
/// Volumes are positive for bodies with outward normals, also if the bodies are open in the planes.
/// \throws Error(open_surface) if there are two planes across every axis
std::vector<double> volumes_of(const TriMesh& mesh, const Components& components, std::span<const EndPlane> ends);

/// Closes `mesh` by one patch for each plane, between the open boundaries in the plane. patches[i] belongs to ends[i]. Where two planes meet, the line between
/// open boundaries is divided. The lengths of its edges grow from both ends, up to the smaller of the `edges` of both planes (m; automatic: no limit). Both
/// planes share the new vertices on the line; there are no other new vertices. The result has long thin triangles, with normals into the fluid.
/// \pre open-boundary vertices lie bit-exactly in their planes
/// \throws Error(open_surface) with locations where open boundaries do not separate inside from outside, and where three planes meet
void fill_ends(TriMesh& mesh, std::span<const EndPlane> ends, std::span<const Patch> patches, std::span<const double> edges, const RunContext& context);

}  // namespace sterna::volmesh
