// Corners, edges and faces of a model that remain after parts too small for the mesh have been absorbed.
#pragma once

#include <vector>

#include "surfmesh/model/model_sizes.h"

namespace sterna::surfmesh {

/// An edge that coincides with another one and runs in the same or in the opposite direction.
struct SameEdge {
  EdgeId edge;
  bool is_reversed = false;
};

struct ModelTopology {
  Column<CornerId, CornerId> corner;      ///< per corner: the corner that represents it
  Column<EdgeId, std::uint8_t> is_point;  ///< true for edges that are degenerate or absorbed
  Column<EdgeId, SameEdge> same_as;       ///< the edge itself, or the edge on the other side of an absorbed strip
  Column<FaceId, std::uint8_t> is_absorbed;
};

/// Absorbs small parts. Edges shorter than their tolerance, or than a twentieth of the shortest target edge, become points. Then faces with two edges whose
/// distance is nowhere larger than that become a line (such as the base of an almost sharp trailing edge). Appends to `absorbed`.
ModelTopology absorb_small_parts(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, std::vector<AbsorbedPart>& absorbed);

}  // namespace sterna::surfmesh
