// Surface meshes of parts, each made in its part's own frame, as one mesh of the parts in their places.
#pragma once

#include <optional>
#include <span>

#include "geom/base/run_context.h"
#include "geom/model/frame.h"
#include "geom/model/model.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// A mesh of one part and where the part is: p -> placement.point(p), in this one expression; a placement without any motion leaves points as they are, to the
/// bit.
struct PlacedMesh {
  const Model* model = nullptr;       ///< of the part, in its own frame
  const SurfaceMesh* mesh = nullptr;  ///< of that model
  Transform placement;                ///< rotation and shift
};

/// Joins the meshes in their order: vertices, triangles, faces, edges and corners of each follow those of the one before; a patch for each name and kind of a
/// face. What the report counts is counted over all; triangles are tested for crossings again, of all parts against all.
/// \pre `model` has the faces, edges and corners of the meshes' models, in this order, in their places; meshes are not empty \return nothing where triangles of
/// different parts cross that finer ones would part: such parts are to be meshed together
/// \throws Error(self_intersection) where triangles cross otherwise, unless options.crossings says so; Error(overflow) beyond max_triangles
std::optional<SurfaceMesh> join_parts(const Model& model, std::span<const PlacedMesh> parts, const SurfaceMeshOptions& options, const RunContext& context);

/// The mesh moved; its report's places too.
void move_points(const Transform& placement, Column<VertexId, Point>& points);
void move_places(const Transform& placement, SurfaceMeshReport& report);

}  // namespace sterna::surfmesh
