// What a surface mesh's report says of its triangles and of those that cross: the same for a mesh that was made at once and for one that was joined of parts.
#pragma once

#include "geom/base/run_context.h"
#include "surfmesh/model/crossings.h"
#include "surfmesh/model/mesh_faces.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// Sets what follows from the faces: their summaries, the worst of their angles and normals, distances of edges.
/// \pre none are in the report yet
void summarise_faces(const Column<FaceId, MeshedFace>& faces, SurfaceMeshReport& report);

/// Sets what follows from the triangles alone: classes of least angles, their 1 % quantile, share within [20, 130] degrees (of `report.faces`), mean radius
/// ratio.
void measure_triangles(SurfaceMesh& mesh);

/// Notes the crossings in the report.
/// \throws Error(self_intersection) where there are any and options.crossings is "error"; else a warning
void report_crossings(const Model& model, const SurfaceMeshOptions& options, const MeshCrossings& crossings, SurfaceMesh& mesh, const RunContext& context);

/// Loose edges by falling distance / tolerance.
void sort_loose_edges(std::vector<LooseEdge>& edges);

}  // namespace sterna::surfmesh
