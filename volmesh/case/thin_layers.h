// Checks whether the layers grow to the size of the adjacent tetrahedra, from the wall triangles alone.
#pragma once

#include <optional>

#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

struct ThinLayers {
  double share = 0.0;  ///< share of the walls' area where the last layer stays thinner than a third of a regular tetrahedron
  int enough = 0;      ///< number of layers that reaches this height on nine tenths of the area, with the same growth
};

/// Estimates for layers of full height. Returns nothing if the share is below a tenth, or if the request is not the same for all walls (patch rules, first
/// heights by location, a given total height): volmesh/inspect handles these cases.
std::optional<ThinLayers> thin_layers(const TriMesh& surface, const MeshCase& options);

}  // namespace sterna::volmesh
