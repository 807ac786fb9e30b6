// Whether so many layers reach the size of the tetrahedra on them, by the triangles of the wall alone.
#pragma once

#include <optional>

#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

struct ThinLayers {
  double share = 0.0;  ///< of the walls' area on which the last of the layers stays thinner than a third of a regular tetrahedron
  int enough = 0;      ///< layers that reach that on nine tenths of the area, with the same growth
};

/// Of layers of full height. Nothing where the share is below a tenth, and where not one request counts for all walls (rules of patches, heights by place, a
/// height that is given): volmesh/inspect knows those.
std::optional<ThinLayers> thin_layers(const TriMesh& surface, const MeshCase& options);

}  // namespace sterna::volmesh
