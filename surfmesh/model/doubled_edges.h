// Edges between the same two border vertices inside of two faces: at the tip of a body of two halves both cut the last triangle off alike, and no refinement
// changes that.
#pragma once

#include <span>

#include "surfmesh/model/join_faces.h"

namespace sterna::surfmesh {

/// Splits each of them, in all faces but the first, at the middle of its (u, v); only where that does not fold. \return how many were split
std::size_t split_doubled_edges(const Model& model, const SurfaceMesh& joined, std::span<const TriangleId> wrong, Column<FaceId, MeshedFace>& faces);

}  // namespace sterna::surfmesh
