// Report of a surface mesh on its triangles and crossings. It is shared by meshes made in one call and meshes joined from parts.
#pragma once

#include "geom/base/run_context.h"
#include "surfmesh/model/crossings.h"
#include "surfmesh/model/mesh_faces.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// Sets the values derived from the faces: their summaries, the worst angles and normals of all faces, and the distances of edges.
/// \pre the report has no face summaries yet
void summarise_faces(const Column<FaceId, MeshedFace>& faces, SurfaceMeshReport& report);

/// Sets the values derived from the triangles alone: histogram of smallest angles, its 1 % quantile, fraction of angles within [20, 130] degrees (from
/// `report.faces`), mean radius ratio.
void measure_triangles(SurfaceMesh& mesh);

/// Adds the crossings to the report. Logs a warning unless options.crossings is "error".
/// \throws Error(self_intersection) if there are crossings and options.crossings is "error"
void report_crossings(const Model& model, const SurfaceMeshOptions& options, const MeshCrossings& crossings, SurfaceMesh& mesh, const RunContext& context);

/// Sorts loose edges by falling ratio of distance to tolerance.
void sort_loose_edges(std::vector<LooseEdge>& edges);

}  // namespace sterna::surfmesh
