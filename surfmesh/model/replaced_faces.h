// Faces of a model whose triangles were replaced when the triangulation was repaired, and the distance of the new triangles from the model.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "surfmesh/model/model_wall.h"

namespace sterna::surfmesh {

/// A face that has triangles its mesher did not make, or fewer than it made.
struct ReplacedFace {
  FaceId face;
  std::string name;
  std::int64_t n_before = 0;  ///< triangles that its mesher made
  std::int64_t n_gone = 0;    ///< number of these that are gone
  std::int64_t n_new = 0;     ///< triangles made instead, counted at the nearest face
  double distance = 0.0;      ///< m, from the model: largest over the new triangles' middles and new corners (sampled beyond 20 000); fillings of holes lie
                              ///< off the model
  Point place{};              ///< location of this distance
};

struct ReplacedFaces {
  std::vector<ReplacedFace> faces;  ///< by falling distance, then by face
  std::int64_t n_exact = 0;         ///< unchanged triangles: their three corners are those of a triangle of the mesher, to the last bit
};

/// Finds the replaced faces. Parallel; the result does not depend on the number of threads.
/// \pre `model` is the model of `made`, which has at least one triangle
ReplacedFaces find_replaced_faces(const ModelWall& model, const TriMesh& made, const TriMesh& repaired, const RunContext& context);

/// Returns one human-readable line for each of the first `most` faces: "face 3 "wing": 14 of 320 triangles replaced by 20, at most 1.2e-05 m from the model,
/// at (...)".
std::vector<std::string> to_lines(const std::vector<ReplacedFace>& faces, std::size_t most);

}  // namespace sterna::surfmesh
