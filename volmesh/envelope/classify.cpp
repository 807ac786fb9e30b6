#include "volmesh/envelope/classify.h"

#include <numbers>

#include "geom/base/parallel.h"
#include "volmesh/envelope/feature_angle.h"

namespace sterna::volmesh {
namespace {

constexpr double k_sharp_angle = 120.0 * std::numbers::pi / 180.0;      ///< docs/method/envelope.md, "Vertex classes"
constexpr double k_ridge_bend_limit = 60.0 * std::numbers::pi / 180.0;  ///< docs/method/envelope.md, "Vertex classes"

Vec3 mirrored(const Vec3& v, const Vec3& normal) { return v - (2.0 * dot(v, normal)) * normal; }

/// The first two feature edges at a vertex, and the number of all feature edges. Mirrored edges are included.
struct FeatureEdges {
  std::size_t n = 0;
  std::array<Vec3, 2> direction;

  void add(const LayerBase& base, VertexId v, VertexId other) {
    const Point& p = base.wall.points[v];
    std::array<Vec3, 4> copies = {base.wall.points[other] - p};
    std::size_t n_copies = 1;
    for (const std::int32_t surface : base.constraint[v].on) {
      const std::size_t k = static_cast<std::size_t>(surface);
      if (surface < 0 || base.constraint[other].is_on(k) || !base.surfaces[k]->is_mirror()) continue;
      const Vec3 normal = base.surfaces[k]->normal(p);
      for (std::size_t i = 0; i < n_copies; ++i) copies[n_copies + i] = mirrored(copies[i], normal);
      n_copies *= 2;
    }
    for (std::size_t i = 0; i < n_copies; ++i, ++n)
      if (n < 2) direction[n] = copies[i];
  }
};

/// Returns the normal of the triangle beyond a boundary edge. If a constraint surface contains the edge, that triangle is the mirror image of the edge's own
/// triangle. Otherwise returns the normal of the edge's own triangle.
Vec3 normal_beyond(const LayerBase& base, HalfedgeId h) {
  const Vec3& own = base.unit_normal[triangle_of(h)];
  const VertexId from = base.topology.from(h), to = base.topology.to(h);
  for (const std::int32_t surface : base.constraint[from].on) {
    const std::size_t k = static_cast<std::size_t>(surface);
    if (surface < 0 || !base.constraint[to].is_on(k)) continue;
    return mirrored(own, base.surfaces[k]->normal(0.5 * (base.wall.points[from] + base.wall.points[to])));
  }
  return own;
}

}  // namespace

double dihedral_deviation(const LayerBase& base, HalfedgeId h) {
  const HalfedgeId twin = base.topology.twin(h);
  const Vec3& n1 = base.unit_normal[triangle_of(h)];
  const Vec3 n2 = twin.is_valid() ? base.unit_normal[triangle_of(twin)] : normal_beyond(base, h);
  const Vec3 edge = base.wall.points[base.topology.to(h)] - base.wall.points[base.topology.from(h)];
  const double angle = angle_between(n1, n2);
  return dot(cross(n1, n2), edge) >= 0.0 ? angle : -angle;
}

Classification classify_vertices(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context) {
  Classification result;
  result.feature_angle = feature_angle_of(base, options, context);
  result.vertex.resize(base.wall.n_vertices());
  result.is_feature.resize(base.topology.n_halfedges());
  Column<HalfedgeId, double> deviation(base.topology.n_halfedges());
  parallel_for(context, base.topology.n_halfedges(), [&](std::size_t i) {
    const HalfedgeId h(i);
    deviation[h] = dihedral_deviation(base, h);
    result.is_feature[h] = std::abs(deviation[h]) > result.feature_angle && !base.is_in_gap(h) ? 1 : 0;
  });
  parallel_for(context, base.wall.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    VertexClass& flags = result.vertex[v];
    FeatureEdges features;
    for_each_edge(base.topology, v, [&](HalfedgeId h, VertexId other) {
      if (!result.is_feature[h]) return;
      features.add(base, v, other);
      (deviation[h] > 0.0 ? flags.is_convex : flags.is_concave) = true;
      (std::abs(deviation[h]) > k_sharp_angle ? flags.is_sharp : flags.is_blunt) = true;
    });
    flags.is_ridge = features.n == 2 && angle_between(features.direction[0], -features.direction[1]) < k_ridge_bend_limit;
    flags.is_corner = features.n > 0 && !flags.is_ridge;
  });
  return result;
}

}  // namespace sterna::volmesh
