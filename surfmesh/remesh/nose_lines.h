// Smooth leading edges of a triangulation as lines of edges: where the surface is bent most and looks straight ahead.
#pragma once

#include <array>
#include <vector>

#include "surfmesh/remesh/reference.h"

namespace sterna::surfmesh {

struct NoseCut {
  TriMesh mesh;                                ///< the wall, edges that noses cross halved; the same patches
  std::vector<std::array<VertexId, 2>> edges;  ///< along noses
};

/// Noses are where the direction across the strongest bend has no part along x. Points of noses lie on the reference's smooth surface; where it `is_flat`, on
/// the triangles. What is no nose of a wing after all (find_row_lines decides) is among them, too.
NoseCut cut_noses(const Reference& reference, bool is_flat, const RunContext& context);

}  // namespace sterna::surfmesh
