// Cuts model edges by the size field along them. Each edge is cut once, so all faces of the edge share the points.
#pragma once

#include <array>
#include <vector>

#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/model_topology.h"
#include "surfmesh/model/periodic_borders.h"
#include "surfmesh/model/surface_sizes.h"
#include "surfmesh/model/wing_bands.h"

namespace sterna::surfmesh {

struct EdgeCut {
  std::vector<double> t;                ///< ascending, strictly inside the edge's range: the ends of the range are corners
  std::vector<Point> points;            ///< curve->point(t); an edge that is the same as another one has the points of that edge
  std::array<std::size_t, 2> n_rows{};  ///< number of points next to the start and to the end that belong to the rows of a band there
  friend bool operator==(const EdgeCut&, const EdgeCut&) = default;
};

/// Cuts each edge into segments of equal length in the metric 1 / size. Closed edges get three segments; at most one of several edges between the same corners
/// has a single segment. Band edges have no segment longer than their stretch allows. Edges that leave a band begin with the heights of its rows. Opposite
/// sides of strips are matched. Borders of periodic sides are cut in the same way, by the smallest of their sizes. The points of an image are the moved points
/// of the original; they are within k_border_tolerance of the curve.
Column<EdgeId, EdgeCut> cut_edges(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelTopology& topology, const WingBands& bands,
                                  const PeriodicBorders& borders, const SurfaceSizes& field, const RunContext& context);

}  // namespace sterna::surfmesh
