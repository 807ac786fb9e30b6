// Every edge of a model cut once, by the size field along it: the points that all its faces share.
#pragma once

#include <array>
#include <vector>

#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/model_topology.h"
#include "surfmesh/model/periodic_rims.h"
#include "surfmesh/model/surface_sizes.h"
#include "surfmesh/model/wing_bands.h"

namespace sterna::surfmesh {

struct EdgeCut {
  std::vector<double> t;                ///< ascending, inside the edge's range: its ends are corners
  std::vector<Point> points;            ///< curve->point(t); of an edge that is the same as another, that one's
  std::array<std::size_t, 2> n_rows{};  ///< so many of the points next to the start, to the end, are rows of a band there
  friend bool operator==(const EdgeCut&, const EdgeCut&) = default;
};

/// Lengths equal in the metric 1 / size; closed edges get three segments, two edges between the same corners more than one between them.
/// Edges of bands have no segment longer than their stretch allows; edges that leave a band begin with the heights of its rows; sides of strips are matched.
/// Borders of periodic sides are cut alike, by the least of their sizes: points of images are those of the first, moved, within k_rim_tolerance of the curve.
Column<EdgeId, EdgeCut> cut_edges(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const WingBands& bands,
                                  const PeriodicRims& rims, const SurfaceSizes& field, const RunContext& context);

}  // namespace sterna::surfmesh
