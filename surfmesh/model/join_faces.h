// Joins the meshes of faces into one triangulation and checks the result.
#pragma once

#include <cstdint>
#include <vector>

#include "surfmesh/model/mesh_faces.h"

namespace sterna::surfmesh {

/// Joins the faces. Faces without a mesh are skipped. The order of vertices is: corners, edges, then the inner vertices of each face. Triangles are sorted by
/// face and oriented outwards.
SurfaceMesh join_faces(const Model& model, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                       const Column<FaceId, MeshedFace>& faces);

/// Triangles with faulty edges. An edge is faulty if it has more than two triangles, or two triangles that run in the same direction. An edge with one triangle
/// is faulty where the model is closed. (Edges that became open because strips along an open boundary were absorbed are not faulty.) Edges beside a face
/// without a mesh are open.
struct JoinFaults {
  std::vector<TriangleId> triangles;  ///< ascending
  std::int64_t n_free_edges = 0;
};
JoinFaults check_joins(const Model& model, const ModelTopology& topology, const Column<FaceId, MeshedFace>& faces, const SurfaceMesh& mesh,
                       const RunContext& context);

}  // namespace sterna::surfmesh
