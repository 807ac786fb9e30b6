// Joins surface meshes of parts, each made in its part's own frame, into one mesh with the parts at their locations.
#pragma once

#include <optional>
#include <span>

#include "geom/base/run_context.h"
#include "geom/model/frame.h"
#include "geom/model/model.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// A mesh of one part and the placement of the part: p -> placement.point(p), in this one expression. A placement without motion leaves points bitwise
/// unchanged.
struct PlacedMesh {
  const Model* model = nullptr;       ///< the part in its own frame
  const SurfaceMesh* mesh = nullptr;  ///< a mesh of that model
  Transform placement;                ///< rotation and shift
};

/// Joins the meshes in their order: vertices, triangles, faces, edges and corners of each follow those of the one before. There is one patch for each name
/// and kind of face. Counts in the report are sums over all parts. Triangles are tested for crossings again, all parts against all.
/// \pre `model` has the faces, edges and corners of the meshes' models, in this order, at their locations; meshes are not empty
/// \return nothing if triangles of different parts cross that refinement would separate: such parts must be meshed together
/// \throws Error(self_intersection) if triangles cross otherwise, unless options.crossings allows it; Error(overflow) beyond max_triangles
std::optional<SurfaceMesh> join_parts(const Model& model, std::span<const PlacedMesh> parts, const SurfaceMeshOptions& options, const RunContext& context);

/// Moves the points of a mesh; move_places() moves the locations in its report.
void move_points(const Transform& placement, Column<VertexId, Point>& points);
void move_places(const Transform& placement, SurfaceMeshReport& report);

}  // namespace sterna::surfmesh
