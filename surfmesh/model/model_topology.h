// Corners, edges and faces of a model that remain after parts too small for the mesh are absorbed.
#pragma once

#include <vector>

#include "surfmesh/model/model_sizes.h"

namespace sterna::surfmesh {

/// An edge that runs along another one, in the same sense or against it.
struct SameEdge {
  EdgeId edge;
  bool is_reversed = false;
};

struct ModelTopology {
  Column<CornerId, CornerId> corner;      ///< the corner that represents it
  Column<EdgeId, std::uint8_t> is_point;  ///< degenerate, or absorbed
  Column<EdgeId, SameEdge> same_as;       ///< itself, or the edge on the other side of an absorbed strip
  Column<FaceId, std::uint8_t> is_absorbed;
};

/// Absorbs small parts. Edges shorter than their tolerance, or than a twentieth of the shortest target edge, become points. Then faces of two edges that are
/// nowhere farther apart than that (the base of an almost sharp trailing edge) become a line. Appends to `absorbed`.
ModelTopology absorb_small_parts(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, std::vector<AbsorbedPart>& absorbed);

}  // namespace sterna::surfmesh
