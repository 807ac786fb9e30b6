// Crossing triangles of a surface mesh: which of them refinement may separate, and how those that remain are reported.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/error.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// A triangle that refinement may separate from another one.
struct RefinableTriangle {
  TriangleId triangle;
  double factor = 0.5;  ///< factor for the edge length there
};

struct MeshCrossings {
  std::vector<std::array<TriangleId, 2>> pairs;  ///< sorted; at most k_most_pairs pairs
  std::int64_t total = 0;
  std::vector<RefinableTriangle> refinable;  ///< ascending: triangles of crossings within one part, and between parts whose surfaces do not meet
};

/// If there are more pairs than this, one part of the model lies inside another, and further pairs add no information.
inline constexpr std::size_t k_most_pairs = 100'000;

/// Finds crossings with exact predicates (geom/math/intersect.h). Triangles of two parts that touch count as well.
MeshCrossings find_mesh_crossings(const Model& model, const SurfaceMesh& mesh, const RunContext& context);

/// Returns the pairs of faces, sorted by falling number of crossings.
std::vector<CrossingFaces> crossing_faces(const Model& model, const SurfaceMesh& mesh, const MeshCrossings& crossings);

/// Returns an error with the faces, locations and triangles, and a remedy: a union if closed parts intersect each other, a repair if a part crosses itself.
/// \pre crossings.total > 0
ErrorInfo crossing_error(const Model& model, const SurfaceMesh& mesh, const MeshCrossings& crossings, const std::vector<CrossingFaces>& faces);

}  // namespace sterna::surfmesh
