// Triangles of a surface mesh that cross: which of them finer triangles may part, and what to say of those that stay.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/error.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// A triangle that finer ones in its place may bring off another one.
struct RefinableTriangle {
  TriangleId triangle;
  double factor = 0.5;  ///< for the length of edges there
};

struct MeshCrossings {
  std::vector<std::array<TriangleId, 2>> pairs;  ///< sorted; the first k_most_pairs
  std::int64_t total = 0;
  std::vector<RefinableTriangle> refinable;  ///< ascending: within one part, and between parts whose surfaces are apart
};

/// Beyond so many pairs a part of the model lies in another one, and more of them say nothing new.
inline constexpr std::size_t k_most_pairs = 100'000;

/// Exact (geom/math/intersect.h). Triangles of two parts that touch count.
MeshCrossings find_mesh_crossings(const Model& model, const SurfaceMesh& mesh, const RunContext& context);

/// Pairs of faces by falling number of crossings.
std::vector<CrossingFaces> crossing_faces(const Model& model, const SurfaceMesh& mesh, const MeshCrossings& crossings);

/// What is wrong, with the faces, places, triangles, and what to try: a union where closed parts stand in each other, mending where a part crosses itself.
/// \pre crossings.total > 0
ErrorInfo crossing_error(const Model& model, const SurfaceMesh& mesh, const MeshCrossings& crossings, const std::vector<CrossingFaces>& faces);

}  // namespace sterna::surfmesh
