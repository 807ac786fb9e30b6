// Adds seams to faces on periodic surfaces whose borders run around the period without a seam. The vertices of such a seam become inner vertices of the face.
#pragma once

#include <functional>
#include <vector>

#include "surfmesh/face/sized_face_mesh.h"
#include "surfmesh/model/face_outline.h"

namespace sterna::surfmesh {

/// A face's border as passed to mesh_face, with the model entity of each of its points (points of all loops in order).
struct LabelledBorder {
  FaceBorder border;
  std::vector<VertexId> ids;                                  ///< vertices of the joined mesh; invalid on the face's own seam
  std::vector<EdgeId> edges;                                  ///< for corners: the edge that starts there; invalid on the face's own seam
  std::vector<Uv> loop_ends;                                  ///< end of each loop: its first location, or that location moved by whole periods
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;  ///< pairs of coincident points; the second point of each pair is removed
};

/// Joins the two loops that run around the period to one loop by a seam. (If there is only one loop, the seam joins it to the pole on its left.) The seam runs
/// there and back, a period apart. It is straight in (u, v) and cut by `size`. Holes are moved between its two sides. Does nothing if all loops close.
/// \throws Error(geometry_failed) if loops run around in another way, or if every straight seam touches a border
void add_own_seam(const Surface& surface, const std::function<double(Uv, const Point&)>& size, LabelledBorder& labelled);

/// Makes the vertices of the seam inner vertices, each of them once; `labelled` keeps only the points of the model.
void free_own_seam(LabelledBorder& labelled, FaceMesh& mesh);

}  // namespace sterna::surfmesh
