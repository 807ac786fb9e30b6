// Which faces of a model have other triangles than their own after its triangulation was repaired, and how far off these are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "surfmesh/model/model_wall.h"

namespace sterna::surfmesh {

/// A face that has triangles which its mesher did not make, or less than it made.
struct ReplacedFace {
  FaceId face;
  std::string name;
  std::int64_t n_before = 0;  ///< triangles that its mesher made
  std::int64_t n_gone = 0;    ///< of them those that are gone
  std::int64_t n_new = 0;     ///< triangles made instead, counted at the face that is nearest
  double distance = 0.0;      ///< m: from the model, the farthest of the new ones' middles and new corners (sampled beyond 20 000); what fills a hole is off it
  Point place{};              ///< there
};

struct ReplacedFaces {
  std::vector<ReplacedFace> faces;  ///< by falling distance, then by face
  std::int64_t n_exact = 0;         ///< triangles that came through: their three corners are those of one that was made, to the last bit
};

/// Parallel, the same for any number of threads.
/// \pre `model` is of `made`, which has a triangle
ReplacedFaces find_replaced_faces(const ModelWall& model, const TriMesh& made, const TriMesh& repaired, const RunContext& context);

/// One line for each of the first `most` faces, for people: "face 3 "wing": 14 of 320 triangles replaced by 20, at most 1.2e-05 m from the model, at (...)".
std::vector<std::string> to_lines(const std::vector<ReplacedFace>& faces, std::size_t most);

}  // namespace sterna::surfmesh
