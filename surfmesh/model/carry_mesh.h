// A surface mesh carried over to another model of the same structure, a deformed one: the same triangles, every vertex where it was in parameters.
#pragma once

#include <optional>
#include <string>

#include "geom/base/run_context.h"
#include "surfmesh/model/model_structure.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// A mesh with the structure of the model that it is of.
struct StructuredMesh {
  ModelStructure structure;
  SurfaceMesh mesh;
};

/// Points of the mesh's vertices on `model`: corners are the model's, vertices on edges at the same parameter of their edge's curve, inner ones at the same (u,
/// v) of their face.
/// \pre difference_of(from.structure, now) is empty, and `now` is of `model`
Column<VertexId, Point> carried_points(const StructuredMesh& from, const Model& model, const ModelStructure& now, const RunContext& context);

/// Of the least angle of a triangle, or of k_good_angle where that is less: what it keeps at least. By 30 % less it is still as good as the mesher's own worst
/// ones mostly are.
inline constexpr double k_kept_angle = 0.7;
/// rad: triangles that keep the share of this are good, however regular they were.
inline constexpr double k_good_angle = 30.0 * 3.14159265358979323846 / 180.0;
/// By which edges get longer or shorter at most: sizes that were asked for hold within two rows of growth 1.2.
inline constexpr double k_edge_stretch = 1.5;
/// rad: by which normals may be farther off than the reference's worst of that face, or than the face's curvature angle.
inline constexpr double k_normal_slack = 10.0 * 3.14159265358979323846 / 180.0;

struct CarriedMesh {
  std::optional<SurfaceMesh> mesh;  ///< nothing: it would not be good
  std::string objection;            ///< then why: "3 triangles fold"
  Point place{};                    ///< and where
};

/// The mesh on `model`, once it is proved as good as one: no triangle folds (its normal against those of the surface at its corners, k_normal_slack), angles
/// and edges are not much worse than the same triangle's were (k_kept_angle, k_edge_stretch), and, unless options.crossings is "ignore", no triangles cross or
/// touch (exact). The report is measured anew, but for what was absorbed (at its vertex' new place), bands and rounds.
/// \pre as carried_points; `points` of it
CarriedMesh carry_mesh(const StructuredMesh& from, const Model& model, const ModelStructure& now, Column<VertexId, Point> points,
                       const SurfaceMeshOptions& options, const RunContext& context);

}  // namespace sterna::surfmesh
