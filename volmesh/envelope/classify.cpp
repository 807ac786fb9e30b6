#include "volmesh/envelope/classify.h"

#include <numbers>

#include "geom/base/parallel.h"

namespace sterna::volmesh {
namespace {

constexpr double k_sharp_angle = 120.0 * std::numbers::pi / 180.0;      ///< method.md §1
constexpr double k_ridge_bend_limit = 60.0 * std::numbers::pi / 180.0;  ///< method.md §1

}  // namespace

double dihedral_deviation(const LayerBase& base, HalfedgeId h) {
  const HalfedgeId twin = base.topology.twin(h);
  if (!twin.is_valid()) return 0.0;
  const Vec3& n1 = base.unit_normal[triangle_of(h)];
  const Vec3& n2 = base.unit_normal[triangle_of(twin)];
  const Vec3 edge = base.wall.points[base.topology.to(h)] - base.wall.points[base.topology.from(h)];
  const double angle = angle_between(n1, n2);
  return dot(cross(n1, n2), edge) >= 0.0 ? angle : -angle;
}

Classification classify_vertices(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context) {
  Classification result;
  result.vertex.resize(base.wall.n_vertices());
  result.is_feature.resize(base.topology.n_halfedges());
  Column<HalfedgeId, double> deviation(base.topology.n_halfedges());
  parallel_for(context, base.topology.n_halfedges(), [&](std::size_t i) {
    const HalfedgeId h(i);
    deviation[h] = dihedral_deviation(base, h);
    result.is_feature[h] = std::abs(deviation[h]) > options.feature_angle ? 1 : 0;
  });
  parallel_for(context, base.wall.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    VertexClass& flags = result.vertex[v];
    std::size_t n_features = 0;
    std::array<Vec3, 2> feature_direction;
    for (const HalfedgeId h : base.topology.outgoing(v)) {
      if (!result.is_feature[h]) continue;
      if (n_features < 2) feature_direction[n_features] = base.wall.points[base.topology.to(h)] - base.wall.points[v];
      ++n_features;
      (deviation[h] > 0.0 ? flags.is_convex : flags.is_concave) = true;
      (std::abs(deviation[h]) > k_sharp_angle ? flags.is_sharp : flags.is_blunt) = true;
    }
    flags.is_ridge = n_features == 2 && angle_between(feature_direction[0], -feature_direction[1]) < k_ridge_bend_limit;
    flags.is_corner = n_features > 0 && !flags.is_ridge;
  });
  return result;
}

}  // namespace sterna::volmesh
