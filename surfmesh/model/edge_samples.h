// Model edges sampled as polylines, which are used to measure lengths, curvatures and distances, and to cut the edges.
#pragma once

#include <vector>

#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna::surfmesh {

struct EdgeSample {
  double t = 0.0;
  Point point;
  double curvature = 0.0;  ///< 1/m, curvature of the curve
};
struct EdgeSamples {
  std::vector<EdgeSample> samples;  ///< samples, both ends included; empty for degenerate edges
  double length = 0.0;              ///< metres, length of the polyline
  double turning = 0.0;             ///< rad, sum of the angles between consecutive segments
};

/// Sets length and turning from the polyline.
void measure_polyline(EdgeSamples& samples);

Column<EdgeId, EdgeSamples> sample_edges(const Model& model, const RunContext& context);

}  // namespace sterna::surfmesh
