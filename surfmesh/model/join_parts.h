// Joins surface meshes of parts, each made in its part's own frame, into one mesh with the parts at their locations.
#pragma once

#include <optional>
#include <span>

#include "geom/base/run_context.h"
#include "geom/model/frame.h"
#include "geom/model/model.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// A mesh of one part and the placement of the part. Each point p is moved to placement.point(p), always by this expression. A placement without motion leaves
/// points bitwise unchanged.
struct PlacedMesh {
  const Model* model = nullptr;       ///< the part in its own frame
  const SurfaceMesh* mesh = nullptr;  ///< a mesh of that model
  Transform placement;                ///< rotation and shift
};

/// Joins the meshes in their order: vertices, triangles, faces, edges and corners of each follow those of the previous mesh. There is one patch for each name
/// and kind of face. Counts in the report are sums over all parts. Triangles of all parts are tested against each other for crossings again.
/// \pre `model` contains the faces, edges and corners of the meshes' models, in this order and at their final locations; the meshes are not empty
/// \return nothing if triangles of different parts cross and refinement would separate them; such parts must be meshed together
/// \throws Error(self_intersection) for other crossings, unless options.crossings allows them; Error(overflow) for more than max_triangles
std::optional<SurfaceMesh> join_parts(const Model& model, std::span<const PlacedMesh> parts, const SurfaceMeshOptions& options, const RunContext& context);

/// Moves the points of a mesh; move_locations() moves the locations in the report of the mesh.
void move_points(const Transform& placement, Column<VertexId, Point>& points);
void move_locations(const Transform& placement, SurfaceMeshReport& report);

}  // namespace sterna::surfmesh
