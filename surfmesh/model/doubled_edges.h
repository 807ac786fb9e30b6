// Edges that join the same two border vertices within two faces. At the tip of a body of two halves both faces cut off the last triangle in the same way, and
// refinement does not change that.
#pragma once

#include <span>

#include "surfmesh/model/join_faces.h"

namespace sterna::surfmesh {

/// Splits each such edge at the middle of its (u, v), in all faces except the first. An edge is not split if triangles would fold. \return number of splits
std::size_t split_doubled_edges(const Model& model, const SurfaceMesh& joined, std::span<const TriangleId> wrong, Column<FaceId, MeshedFace>& faces);

}  // namespace sterna::surfmesh
