// Literal implementation of the definitions of docs/method/quality.md, "Median dual": one loop over cells, faces and edges, with maps for everything. Slow, for
// small meshes only.
#pragma once

#include "geom/mesh/dual_metrics.h"

namespace sterna::test {

struct NaiveDual {
  std::vector<NodeMetrics> nodes;  ///< without relative_face_area_ratio and edge_ratio
  double volume = 0.0;             ///< sum of all sub-tets
  double least_sub_volume = 0.0;
};
NaiveDual naive_dual(const HybridMesh& mesh);

}  // namespace sterna::test
