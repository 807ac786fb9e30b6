// The definitions of docs/method/quality.md, "Median dual" written down as they stand: one loop over cells, faces and edges, maps for everything. Slow; for
// small meshes.
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
