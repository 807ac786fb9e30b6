// Borders between walls with layers and patches without layers at which a layer cannot end. They are outer edges, such as the edge of a nacelle around its
// nozzle.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Returns true if the fluid's angle at an edge of the wall is above 178 degrees. The side of a layer that ends there would be in the fluid, not on the patch
/// beyond. \param of_wall half-edge of a triangle with layers; \pre its twin belongs to a triangle
bool is_open_border(const TriMesh& surface, const Topology& topology, HalfedgeId of_wall);

/// Returns the inflow and outflow patches without layers that meet a wall with layers at such an edge, ascending. Builds a topology only if such patches touch
/// the wall.
/// \throws Error(non_manifold_surface) like Topology
std::vector<PatchId> flow_patches_beyond_open_borders(const TriMesh& boundary, const Column<PatchId, std::uint8_t>& has_layer, const RunContext& context);

}  // namespace sterna::volmesh
