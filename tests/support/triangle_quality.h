// Quality of a surface mesh as a whole, for tests and benchmarks: the numbers of tools/compare_gmsh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

struct TriangleQuality {
  double radius_ratio = 0.0;      ///< 2 r / R, mean by area
  double min_angle = 0.0;         ///< degrees
  double angle_quantile_1 = 0.0;  ///< degrees: 1 % of triangles have a smaller angle than this
  double max_angle = 0.0;         ///< degrees
  double share_of_six = 0.0;      ///< vertices that are not on a free edge and have six neighbours, of all that are not
};

TriangleQuality measure_triangles(std::span<const Point> points, std::span<const TriangleVertices> triangles);

}  // namespace sterna::test
