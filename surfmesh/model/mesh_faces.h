// Meshes the faces of a model on their shared edges, in parallel. Faces that cannot be meshed are returned with an error and its location.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "surfmesh/face/sized_face_mesh.h"
#include "surfmesh/model/edge_cuts.h"
#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/surface_sizes.h"

namespace sterna::surfmesh {

/// Numbers of the vertices on corners and edges. The remaining corners come first, in their order, then the cuts of each edge.
struct BorderVertices {
  Column<CornerId, VertexId> of_corner;  ///< invalid if no edge ends in the corner
  Column<EdgeId, std::uint32_t> first_of_edge;
  std::uint32_t n_corners = 0;
  std::uint32_t n = 0;
};
BorderVertices number_border(const Model& model, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts);

struct MeshedFace {
  FaceMesh mesh;
  std::vector<VertexId> border_ids;  ///< numbers of the first n_border vertices of the face in the joined mesh
  std::optional<ErrorInfo> failure;  ///< set instead of a mesh
  FaceMeshSummary summary;
  double edge_distance = 0.0;  ///< metres: largest distance of a border point from the surface
  Point edge_distance_location{};
  std::vector<LooseEdge> loose_edges;  ///< loose edges of this face
  BandMeasures bands;
  std::vector<std::string> notes;  ///< names of rows or strips that had to be omitted
};

/// Returns the vertices of a face's border in the order in which they are passed to mesh_face.
std::vector<VertexId> border_ids(const Model& model, FaceId f, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts,
                                 const BorderVertices& numbers, const FaceOutline& outline);

/// Meshes face f. Failures that shorter edges may remove are returned; other failures are thrown with the name of the face.
MeshedFace mesh_one_face(const Model& model, FaceId f, const ModelTopology& topology, const Column<EdgeId, EdgeCut>& cuts, const BorderVertices& numbers,
                         const ModelSizes& sizes, const WingBands& bands, const SurfaceSizes& field, int max_triangles, const RunContext& context);

/// Adds angles (from the report of its mesh), normals and areas of a face's triangles to its summary.
void measure_face(MeshedFace& face);
/// Measures the distances of the border's points from the surface, and for each edge the distances that exceed the model's tolerances. \p edges edge of each
/// border point; invalid if not known
void measure_border(const Model& model, const std::vector<EdgeId>& edges, MeshedFace& face);

}  // namespace sterna::surfmesh
