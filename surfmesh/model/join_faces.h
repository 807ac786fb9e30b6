// Joins the meshes of faces into one triangulation and checks the result.
#pragma once

#include <cstdint>
#include <vector>

#include "surfmesh/model/mesh_faces.h"

namespace sterna::surfmesh {

/// Joins the faces; faces without a mesh are skipped. Vertex order: corners, edges, then the inner ones of each face. Triangles face by face, oriented
/// outwards.
SurfaceMesh join_faces(const Model& model, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                       const Column<FaceId, MeshedFace>& faces);

/// Triangles with faulty edges: edges with more than two triangles, with two triangles that run the same way, or with one triangle where the model is not
/// open (and was not open before strips along its open boundary were absorbed). Neighbours of a face without a mesh are open.
struct JoinFaults {
  std::vector<TriangleId> triangles;  ///< ascending
  std::int64_t n_free_edges = 0;
};
JoinFaults check_joins(const Model& model, const ModelTopology& topology, const Column<FaceId, MeshedFace>& faces, const SurfaceMesh& mesh,
                       const RunContext& context);

}  // namespace sterna::surfmesh
