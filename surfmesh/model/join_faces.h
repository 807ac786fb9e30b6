// Meshes of faces put together into one triangulation, and what is wrong with it.
#pragma once

#include <cstdint>
#include <vector>

#include "surfmesh/model/mesh_faces.h"

namespace sterna::surfmesh {

/// Faces without a mesh are left out. Vertices: corners, edges, then the inner ones of each face; triangles face by face, turned outwards.
SurfaceMesh join_faces(const Model& model, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                       const Column<FaceId, MeshedFace>& faces);

/// Triangles whose edges have more than two triangles, or two that run the same way, or one where the model is not open (nor was, before strips along its rims
/// were absorbed). A face that has no mesh leaves its neighbours open.
struct JoinFaults {
  std::vector<TriangleId> triangles;  ///< ascending
  std::int64_t n_free_edges = 0;
};
JoinFaults check_joins(const Model& model, const ModelTopology& topology, const Column<FaceId, MeshedFace>& faces, const SurfaceMesh& mesh,
                       const RunContext& context);

}  // namespace sterna::surfmesh
