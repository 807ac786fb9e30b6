// Checks from the wall triangles alone if the layers grow to the size of the adjacent tetrahedra.
#pragma once

#include <optional>

#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

struct ThinLayers {
  double share = 0.0;  ///< fraction of the walls' area on which the last layer stays thinner than a third of a regular tetrahedron
  int enough = 0;      ///< number of layers whose last cell reaches this height on nine tenths of the area, with the same growth
};

/// Estimates this for layers of full height. Returns nothing if the fraction is below a tenth, or if the request is not the same for all walls (patch rules,
/// first heights that depend on the location, a given total height). volmesh/inspect handles these cases.
std::optional<ThinLayers> thin_layers(const TriMesh& surface, const MeshCase& options);

}  // namespace sterna::volmesh
