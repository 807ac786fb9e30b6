#include "volmesh/layer/layer_line.h"

#include <algorithm>
#include <cmath>

#include "volmesh/case/growth_law.h"

namespace sterna::volmesh {
namespace {

/// Below this c_t the curve is straight after less than a thousandth of the height.
constexpr double k_straight = 1e-3;
/// Of h: the least normal height that the layer law is given (a line at 84 degrees to the wall normal).
constexpr double k_min_normal_share = 0.1;
/// Just within the 2 % of G11: of the first node along its wall normal, and along the normals of its triangles.
constexpr double k_max_first_height_factor = 1.019;
constexpr double k_least_facet_height = 0.981;

}  // namespace

double normal_height(const LayerBase& base, const Envelope& envelope, VertexId v) {
  return envelope.height[v] * std::max(dot(envelope.direction[v], base.vertex_normal[v]), k_min_normal_share);
}

double first_height_factor(const LayerBase& base, VertexId v) {
  double area = 0.0, projected = 0.0, least = 1.0;
  for_each_alike(base, v, [&](VertexId w) {
    for (const HalfedgeId h : base.topology.outgoing(w)) {
      const TriangleId t = triangle_of(h);
      const double cosine = dot(base.unit_normal[t], base.vertex_normal[v]);
      area += base.area[t];
      projected += base.area[t] * cosine;
      least = std::min(least, cosine);
    }
  });
  if (least <= k_least_facet_height / k_max_first_height_factor || projected * k_max_first_height_factor <= area) return k_max_first_height_factor;
  return std::max(area / projected, k_least_facet_height / least);
}

LinePlacer::LinePlacer(const LayerBase& base, const EnvelopeScale& scale) : base_(base), scale_(scale), t_(static_cast<std::size_t>(scale.most_layers()) + 1) {}

void LinePlacer::place(const Envelope& envelope, VertexId v, double c_t, Point* nodes) {
  const Point wall = base_.wall.points[v];
  nodes[0] = wall;
  if (envelope.is_collapsed(v)) return;
  const double h_n = normal_height(base_, envelope, v);
  const int n = scale_.n(v);
  layer_parameters(scale_.h0(v) * first_height_factor(base_, v), h_n, n, t_.data());
  const Vec3 along = envelope.height[v] * envelope.direction[v];
  const Vec3 aside = h_n * base_.vertex_normal[v] - along;
  const bool is_curved = c_t >= k_straight;
  const double end = is_curved ? std::exp(-1.0 / c_t) : 0.0;
  const double scale = 1.0 / (1.0 - end);
  for (int j = 1; j < n; ++j) {
    const double t = t_[static_cast<std::size_t>(j)];
    const double s = is_curved ? (std::exp(-t / c_t) - end) * scale : 0.0;
    nodes[j] = wall + t * (along + s * aside);
  }
  nodes[n] = envelope.point(base_.wall, v);
  const VertexConstraint& constraint = base_.constraint[v];
  if (constraint.freedom != Freedom::surface) return;  // planes and lines hold exactly by their directions
  const ConstraintSurface& surface = *base_.surfaces[static_cast<std::size_t>(constraint.on[0])];
  for (int j = 1; j < n; ++j) nodes[j] = surface.closest(nodes[j]);
}

}  // namespace sterna::volmesh
