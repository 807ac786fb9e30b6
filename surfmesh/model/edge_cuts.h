// Every edge of a model cut once, by the size field along it: the points that all its faces share.
#pragma once

#include <vector>

#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/model_topology.h"
#include "surfmesh/model/surface_sizes.h"

namespace sterna::surfmesh {

struct EdgeCut {
  std::vector<double> t;       ///< ascending, inside the edge's range: its ends are corners
  std::vector<Point> points;   ///< curve->point(t); of an edge that is the same as another, that one's
  friend bool operator==(const EdgeCut&, const EdgeCut&) = default;
};

/// Lengths equal in the metric 1 / size; closed edges get three segments, two edges between the same corners more than one between them.
Column<EdgeId, EdgeCut> cut_edges(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const SurfaceSizes& field, const RunContext& context);

}  // namespace sterna::surfmesh
