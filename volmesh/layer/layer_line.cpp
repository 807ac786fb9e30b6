#include "volmesh/layer/layer_line.h"

#include <algorithm>
#include <cmath>

#include "volmesh/case/growth_law.h"

namespace sterna::volmesh {
namespace {

/// With a smaller c_t the curve is straight after less than a thousandth of the height.
constexpr double k_straight = 1e-3;
/// A growth line that bends within its flat cells changes the proportions of these cells above facets that are inclined to the vertex's normal. Steps along
/// such a facet change by 0.5 t / c_t from cell to cell, and the limit is 11 h / e (growth_law.h). A cell of height h at t has h = 0.2 t H if cells grow by
/// 1.25. Therefore c_t must be at least this constant times e / H, times the tangent of the growth line's inclination and the sine of the facet's inclination.
constexpr double k_flat_curving = 0.23;
/// Tangent of an inclination. A straight growth line with a larger inclination cannot have its first height, because of the lower limit of normal_height().
constexpr double k_steepest = 9.9;
}  // namespace

LinePlacer::LinePlacer(Borrowed<const LayerBase> base, const EnvelopeScale& scale)
    : base_(base), scale_(scale), t_(static_cast<std::size_t>(scale.most_layers()) + 1) {}

/// Returns the smallest c_t of a growth line that is not straight. With local growth the proportions change in any case.
double LinePlacer::least_curving(VertexId v, double aside, double height) const {
  if (!scale_.has_common_growth() || aside > k_steepest * height) return 0.0;
  const double cosine = base_.worst_cosine(v, base_.vertex_normal[v]);
  return k_flat_curving * (base_.longest_edge[v] / height) * (aside / height) * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
}

void LinePlacer::place(const Envelope& envelope, VertexId v, int n, double c_t, Point* nodes) {
  const Point wall = base_.wall.points[v];
  nodes[0] = wall;
  if (envelope.is_collapsed(v)) return;
  const double h_n = normal_height(base_, envelope, v);
  layer_parameters(scale_.growth(v), h_n, n, t_.data());
  const Vec3 along = envelope.height[v] * envelope.direction[v];
  const Vec3 aside = h_n * base_.vertex_normal[v] - along;
  const bool is_curved = c_t >= std::max(k_straight, least_curving(v, norm(aside), h_n)) && base_.multi_normal_of(v) == nullptr;
  const double end = is_curved ? std::exp(-1.0 / c_t) : 0.0;
  const double scale = 1.0 / (1.0 - end);
  for (int j = 1; j < n; ++j) {
    const double t = t_[static_cast<std::size_t>(j)];
    const double s = is_curved ? (std::exp(-t / c_t) - end) * scale : 0.0;
    nodes[j] = wall + t * (along + s * aside);
  }
  nodes[n] = envelope.point(base_.wall, v);
  const VertexConstraint& constraint = base_.constraint[v];
  if (constraint.freedom != Freedom::surface) return;  // directions already satisfy constraints to planes and lines exactly
  const ConstraintSurface& surface = *base_.surfaces[static_cast<std::size_t>(constraint.on[0])];
  for (int j = 1; j < n; ++j) nodes[j] = surface.closest(nodes[j]);
}

}  // namespace sterna::volmesh
