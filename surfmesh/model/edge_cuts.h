// Every edge of a model cut once, by the size field along it: the points that all its faces share.
#pragma once

#include <vector>

#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/model_sizes.h"

namespace sterna::surfmesh {

/// Which corners and edges are still there: edges that are too short are points.
struct ModelTopology {
  Column<CornerId, CornerId> corner;      ///< the corner that stands for it
  Column<EdgeId, std::uint8_t> is_point;  ///< degenerate, or absorbed
};
/// Absorbs edges shorter than their tolerance or than `k_shortest` of what is wanted there. Appends to `absorbed`.
ModelTopology absorb_short_edges(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, std::vector<AbsorbedPart>& absorbed);

struct EdgeCut {
  std::vector<double> t;       ///< ascending, inside the edge's range: its ends are corners
  std::vector<Point> points;   ///< curve->point(t)
  friend bool operator==(const EdgeCut&, const EdgeCut&) = default;
};

/// Lengths equal in the metric 1 / size; closed edges get three segments, two edges between the same corners more than one between them.
Column<EdgeId, EdgeCut> cut_edges(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const ModelSizes& sizes, const SizeField& field, const RunContext& context);

}  // namespace sterna::surfmesh
