#include "surfmesh/face/sized_face_mesh.h"

#include <algorithm>

#include "surfmesh/face/face_sizes.h"

namespace sterna::surfmesh {

FaceMesh mesh_face(const Surface& surface, const FaceBorder& border, const SizeFunction& size, const FaceMeshOptions& options, const RunContext& context) {
  delaunay::check_border(border);
  std::vector<std::vector<Uv>> loops;
  for (const auto& loop : border.loops) {
    loops.emplace_back();
    for (const BorderPoint& p : loop) loops.back().push_back(p.uv);
  }
  const CurvatureLimits limits{.angle = options.curvature_angle, .min_edge = options.min_edge, .growth = options.size_growth};
  CurvatureSizes curvature_sizes(surface, box_of(border), loops);
  curvature_sizes.limit(limits);
  const SizeFunction with_curvature = [&](Uv at, const Point& point) { return std::min(size(at, point), curvature_sizes(at)); };
  return mesh_face(surface, border, with_curvature, Vec2{curvature_sizes.mean_speed_u(), curvature_sizes.mean_speed_v()}, options, context);
}

}  // namespace sterna::surfmesh
