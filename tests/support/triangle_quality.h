// Quality of a whole surface mesh, for tests and benchmarks: the measures of tools/compare_gmsh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

struct TriangleQuality {
  double radius_ratio = 0.0;      ///< 2 r / R, area-weighted mean
  double min_angle = 0.0;         ///< degrees
  double angle_quantile_1 = 0.0;  ///< degrees: 1 % of triangles have a smaller angle
  double max_angle = 0.0;         ///< degrees
  double share_of_six = 0.0;      ///< fraction of the vertices not on a free edge that have six neighbours
};

TriangleQuality measure_triangles(std::span<const Point> points, std::span<const TriangleVertices> triangles);

}  // namespace sterna::test
