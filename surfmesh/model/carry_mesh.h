// Transfer of a surface mesh to another model of the same structure, such as a deformed one. Triangles and parameters stay the same.
#pragma once

#include <optional>
#include <string>

#include "geom/base/run_context.h"
#include "surfmesh/model/model_structure.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// A mesh with the structure of its model.
struct StructuredMesh {
  ModelStructure structure;
  SurfaceMesh mesh;
};

/// Returns the points of the mesh's vertices on `model`. Corner vertices take the corners of the model, vertices on edges keep the parameter on their edge's
/// curve, and inner vertices keep (u, v) on their face.
/// \pre difference_of(from.structure, now) is empty, and `now` is the structure of `model`
Column<VertexId, Point> carried_points(const StructuredMesh& from, const Model& model, const ModelStructure& now, const RunContext& context);

/// A triangle must keep at least this fraction of its smallest angle, or of k_good_angle if that is less. After a loss of 30 % a triangle is mostly still as
/// good as the worst triangles that the mesher itself makes.
inline constexpr double k_kept_angle = 0.7;
/// Rad: triangles that keep the fraction k_kept_angle of this angle are accepted, however regular they were before.
inline constexpr double k_good_angle = 30.0 * 3.14159265358979323846 / 180.0;
/// Largest factor by which edges may become longer or shorter: the target sizes then hold within two rows of growth 1.2.
inline constexpr double k_edge_stretch = 1.5;
/// Rad: the normal deviation may exceed the reference's worst value of that face, or the face's curvature angle, by at most this angle.
inline constexpr double k_normal_slack = 10.0 * 3.14159265358979323846 / 180.0;

struct CarriedMesh {
  std::optional<SurfaceMesh> mesh;  ///< empty if the mesh would not be good enough
  std::string objection;            ///< the reason in that case, such as "3 triangles fold"
  Point location{};                 ///< location of the problem
};

/// Returns the mesh on `model` if it passes the following tests. No triangle folds: its normal is compared with the surface normals at its corners
/// (k_normal_slack). Angles and edges are not much worse than those of the same triangle before (k_kept_angle, k_edge_stretch). No triangles cross or touch
/// (exact test), unless options.crossings is "ignore". The report is measured again, except for bands, rounds, and absorbed faces and edges, which are reported
/// at the new location of their vertex.
/// \pre the same as for carried_points, which returned `points`
CarriedMesh carry_mesh(const StructuredMesh& from, const Model& model, const ModelStructure& now, Column<VertexId, Point> points,
                       const SurfaceMeshOptions& options, const RunContext& context);

}  // namespace sterna::surfmesh
