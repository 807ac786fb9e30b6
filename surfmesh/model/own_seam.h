// Seams for faces on periodic surfaces whose borders run around the period without a seam. Such a face gets its own seam, whose vertices become inner ones.
#pragma once

#include <functional>
#include <vector>

#include "surfmesh/face/face_mesh.h"
#include "surfmesh/model/face_outline.h"

namespace sterna::surfmesh {

/// A face's border as passed to mesh_face, with the model entity of each of its points (all loops in order).
struct LabelledBorder {
  FaceBorder border;
  std::vector<VertexId> ids;                                  ///< vertices of the joined mesh; invalid on the face's own seam
  std::vector<EdgeId> edges;                                  ///< corners: the edge that starts there; invalid likewise
  std::vector<Uv> loop_ends;                                  ///< end of each loop: its first location, or that location moved by periods
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;  ///< pairs of coincident points: the second is removed
};

/// Joins the two loops that run around the period (or the one loop, to the pole on its left) to one loop by a seam. The seam runs there and back, a period
/// apart, straight in (u, v), cut by `size`. Holes are moved between its sides. Does nothing if all loops close.
/// \throws Error(geometry_failed) if loops run around in another way, or no straight seam clears the borders
void add_own_seam(const Surface& surface, const std::function<double(Uv, const Point&)>& size, LabelledBorder& labelled);

/// Makes the seam's vertices inner ones, each once; `labelled` keeps only the model's points.
void free_own_seam(LabelledBorder& labelled, FaceMesh& mesh);

}  // namespace sterna::surfmesh
