// Faces on periodic surfaces whose borders run around the period without a seam: they get one of their own, which is free inside the face.
#pragma once

#include <functional>
#include <vector>

#include "surfmesh/face/face_mesh.h"
#include "surfmesh/model/face_outline.h"

namespace sterna::surfmesh {

/// A face's border as mesh_face takes it, with what each of its points (all loops in order) is in the model.
struct LabelledBorder {
  FaceBorder border;
  std::vector<VertexId> ids;                                  ///< of the joined mesh; invalid on a seam of the face's own
  std::vector<EdgeId> edges;                                  ///< corners: the edge that starts there; invalid likewise
  std::vector<Uv> loop_ends;                                  ///< where each loop arrives: its first place, or that moved by periods
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;  ///< points that are one: the second goes
};

/// Joins the two loops that run around the period (or the one, to the pole on its left) to one loop by a seam: there and back, a period apart, straight in (u,
/// v), cut by `size`; moves holes between. Nothing where all loops close.
/// \throws Error(geometry_failed) where loops run around in another way, or no straight seam clears the borders
void add_own_seam(const Surface& surface, const std::function<double(Uv, const Point&)>& size, LabelledBorder& labelled);

/// Makes the seam's vertices inner ones, each once; `labelled` keeps the model's points alone.
void free_own_seam(LabelledBorder& labelled, FaceMesh& mesh);

}  // namespace sterna::surfmesh
