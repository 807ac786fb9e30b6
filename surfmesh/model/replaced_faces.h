// Faces of a model whose triangles were replaced when the triangulation was repaired, and the distance of the new triangles from the model.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "surfmesh/model/model_wall.h"

namespace sterna::surfmesh {

/// A face whose triangles include some that its mesher did not make, or that has lost triangles.
struct ReplacedFace {
  FaceId face;
  std::string name;
  std::int64_t n_before = 0;  ///< triangles that its mesher made
  std::int64_t n_gone = 0;    ///< number of these triangles that are gone
  std::int64_t n_new = 0;     ///< triangles made instead; each is counted at the nearest face
  double distance = 0.0;  ///< m: largest distance from the model of the middles and new corners of the new triangles (sampled if there are more than 20 000);
                          ///< fillings of holes do not lie on the model
  Point location{};       ///< location of this distance
};

struct ReplacedFaces {
  std::vector<ReplacedFace> faces;  ///< sorted by falling distance, then by face
  std::int64_t n_exact = 0;         ///< unchanged triangles: their three corners are bitwise those of a triangle of the mesher
};

/// Finds the replaced faces. Parallel; the result does not depend on the number of threads.
/// \pre `model` is the model of `made`, which has at least one triangle
ReplacedFaces find_replaced_faces(const ModelWall& model, const TriMesh& made, const TriMesh& repaired, const RunContext& context);

/// Returns one human-readable line for each of the first `most` faces: "face 3 "wing": 14 of 320 triangles replaced by 20, at most 1.2e-05 m from the model,
/// at (...)".
std::vector<std::string> to_lines(const std::vector<ReplacedFace>& faces, std::size_t most);

}  // namespace sterna::surfmesh
