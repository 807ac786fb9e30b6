#include "volmesh/envelope/layer_objective.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/parallel.h"
#include "volmesh/envelope/multi_normal_taper.h"

namespace sterna::volmesh {
namespace {

/// If the ratio of the bounds is less than this, the vertex is fixed (docs/method/optimisation.md, "Bounds").
constexpr double k_min_bound_ratio = 1.05;
constexpr double k_wide_reserve = 0.01;  ///< an element gets the wide margins if its slack above them is at least this at the start

/// Returns the fraction of a vertex of the full model that is in this model: half or a quarter on mirror planes, where a growth line has only its own
/// triangles.
double mirror_share(const LayerBase& base, VertexId v) {
  const VertexConstraint& constraint = base.constraint[v];
  if (constraint.on[0] >= 0 && !base.surfaces[static_cast<std::size_t>(constraint.on[0])]->is_mirror()) return 1.0;
  switch (constraint.freedom) {
    case Freedom::plane:
    case Freedom::surface: return 0.5;
    case Freedom::line: return 0.25;
    default: return 1.0;
  }
}

}  // namespace

LayerObjective::LayerObjective(Borrowed<const LayerBase> base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, double least_quality,
                               const ObjectiveWeights& weights, const RunContext& context, const Column<VertexId, double>& floor)
    : base_(base), weights_(weights), least_quality_(least_quality), h_u_(h_u.raw()) {
  const std::size_t n = base->wall.n_vertices();
  h_l_share_.assign(n, 1.0);
  least_length_.assign(n, 0.0);
  is_moving_.assign(n, 0);
  normal_.resize(n);
  normal_sum_.assign(n, Vec3{});
  n_incident_.assign(n, 0.0);
  mirror_share_.assign(n, 1.0);
  is_element_.assign(base->wall.n_triangles(), 0);
  has_wide_margins_.assign(base->wall.n_triangles(), 1);
  const auto stands = [&](TriangleId t) {
    const TriangleVertices& v = base->wall.triangles[t];
    return !start.is_collapsed(v[0]) && !start.is_collapsed(v[1]) && !start.is_collapsed(v[2]);
  };
  parallel_for(context, n, [&](std::size_t i) {
    const VertexId v(i);
    normal_[i] = base->vertex_normal[v];
    mirror_share_[i] = mirror_share(base, v);
    if (start.is_collapsed(v) || base->constraint[v].freedom == Freedom::fixed || is_tapered(base, start, v)) return;
    const double h = dot(start.height[v] * start.direction[v], normal_[i]);
    h_u_[i] = std::max(h_u_[i], h);  // the start must lie within the bounds, so they are extended
    if (!(h > 0.0) || h_u_[i] < k_min_bound_ratio * h_l) return;
    h_l_share_[i] = std::min(h, h_l) / h_u_[i];
    if (!floor.empty()) least_length_[i] = std::min(start.height[v], floor[v]) / h_u_[i];
    is_moving_[i] = 1;
    for (const HalfedgeId half : base->topology.outgoing(v)) {
      const TriangleId t = triangle_of(half);
      if (!stands(t)) {
        is_moving_[i] = 0;  // pyramids and tetrahedra beside collapsed vertices stay unchanged
        return;
      }
      normal_sum_[i] += base->unit_normal[t];
      n_incident_[i] += 1.0;
    }
  });
  parallel_for(context, is_element_.size(), [&](std::size_t i) {
    const TriangleVertices& v = base->wall.triangles[TriangleId(i)];
    is_element_[i] = stands(TriangleId(i)) && (is_moving_[v[0].index()] || is_moving_[v[1].index()] || is_moving_[v[2].index()]);
  });
  const bool has_barrier = weights.top > 0.0 || weights.barrier > 0.0;
  const Vec3Field y = unknowns(start);
  if (has_barrier) {
    parallel_for(context, is_element_.size(), [&](std::size_t t) {
      LayerElement e;
      has_wide_margins_[t] = load(t, y, e) && e.measure() > k_wide_reserve;
    });
    // Elements exactly on the least margins (because of rounding) have no barrier. Their vertices do not move.
    for (std::size_t t = 0; t < is_element_.size(); ++t) {
      LayerElement e;
      if (has_wide_margins_[t] || !load(t, y, e) || e.measure() > 0.0) continue;
      is_element_[t] = 0;
      for (const VertexId v : base->wall.triangles[TriangleId(t)]) is_moving_[v.index()] = 0;
    }
    folds_ = LayerFolds(base, start, is_moving_, context);
    for (const std::uint32_t v : folds_.drop_infeasible(base, start)) is_moving_[v] = 0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    n_moving_ += is_moving_[i];
    if (is_moving_[i]) n_counted_ += mirror_share_[i];
  }
  for (const std::uint8_t is_one : is_element_) n_elements_ += is_one;
}

Vec3Field LayerObjective::unknowns(const Envelope& envelope) const {
  Vec3Field y(size());
  for (std::size_t i = 0; i < y.size(); ++i)
    if (h_u_[i] > 0.0) y[i] = (envelope.height[VertexId(i)] / h_u_[i]) * envelope.direction[VertexId(i)];
  return y;
}

void LayerObjective::store(const Vec3Field& y, Envelope& envelope) const {
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (!is_moving_[i]) continue;
    const VertexId v(i);
    Vec3 g = h_u_[i] * y[i];
    const VertexConstraint& constraint = base_.constraint[v];
    if (constraint.freedom == Freedom::surface)
      g = base_.surfaces[static_cast<std::size_t>(constraint.on[0])]->closest(base_.wall.points[v] + g) - base_.wall.points[v];
    envelope.height[v] = norm(g);
    envelope.direction[v] = normalized(g);
  }
}

void LayerObjective::clamp(std::size_t v, Vec3& y) const {
  const double length = norm(y);
  if (length < least_length_[v]) y *= least_length_[v] / length;
  const double h = dot(y, normal_[v]);
  const double inside = std::clamp(h, h_l_share_[v], 1.0);
  if (inside != h) y += (inside - h) * normal_[v];
}

bool LayerObjective::load(std::size_t t, const Vec3Field& y, LayerElement& e) const {
  if (!is_element_[t]) return false;
  const TriangleId id(t);
  const TriangleVertices& v = base_.wall.triangles[id];
  const Point& p = base_.wall.points[v[0]];
  e.margins = margins_of(t);
  e.is_virtual = base_.is_virtual(id);
  e.n_wall = base_.unit_normal[id];
  e.wall_area2 = 2.0 * base_.area[id];
  std::array<Vec3, 3> g;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = v[k].index();
    g[k] = h_u_[i] * y[i];
    e.set_growth(k, g[k]);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    e.e[k] = base_.wall.points[v[k + 1]] - p;
    e.top[k] = e.e[k] + (g[k + 1] - g[0]);
  }
  e.set_corners();
  return true;
}

FoldPoints LayerObjective::fold_points(std::size_t fold, const Vec3Field& y) const {
  FoldPoints points;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t v = folds_.corners(fold)[k];
    points[k] = base_.wall.points[VertexId(v)] + h_u_[v] * y[v];
  }
  return points;
}

double LayerObjective::fold_energy(const Fold& shape, std::size_t fold) const {
  const double slack = fold_slack(shape, folds_.limit(fold));
  if (slack >= 1.0) return 0.0;
  return slack > 0.0 ? barrier_value(slack, 1.0) : std::numeric_limits<double>::infinity();
}

double LayerObjective::sum_of_folds(const Vec3Field& y, const RunContext& context) const {
  return parallel_reduce(
      context, folds_.size(), 0.0,
      [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t i = begin; i < end; ++i) sum += fold_energy(fold_of(fold_points(i, y)), i);
        return sum;
      },
      [](double a, double b) { return a + b; });
}

LayerObjective::Membrane LayerObjective::membrane(std::size_t v, double height, const Vec3Field& y) const {
  Membrane sum;
  if (weights_.membrane == 0.0) return sum;
  for (const VertexId w : base_.topology.neighbours(VertexId(v))) {
    const std::size_t other = w.index();
    if (y[other] == Vec3{} || base_.share_base_vertex(VertexId(v), w))
      continue;  // the edge leads to a collapsed vertex, or to one with the same ridge base vertex
    const double length = distance(base_.wall.points[VertexId(v)], base_.wall.points[w]), weight = membrane_weight(v, other) / (length * length);
    const double rise = height - normal_height(other, y[other]), energy = 0.5 * weight * rise * rise;
    sum.energy += energy;
    sum.share += is_moving_[other] ? 0.5 * energy : energy;
    sum.slope += weight * rise;
    sum.curvature += weight;
  }
  return sum;
}

ObjectiveValue LayerObjective::evaluate(const Vec3Field& y, const RunContext& context) const {
  const double element_weight = corner_weight();
  const auto add = [](ObjectiveValue a, const ObjectiveValue& b) {
    a.f1 += b.f1;
    a.f2 += b.f2;
    a.f3 += b.f3;
    a.f4 += b.f4;
    a.barrier += b.barrier;
    return a;
  };
  const ElementWeights weights = element_weights();
  const bool needs_elements = weights.top > 0.0 || weights.barrier > 0.0;
  ObjectiveValue value = parallel_reduce(
      context, needs_elements ? is_element_.size() : 0, ObjectiveValue{},
      [&](std::size_t begin, std::size_t end) {
        ObjectiveValue sum;
        for (std::size_t t = begin; t < end; ++t) {
          LayerElement e;
          if (!load(t, y, e)) continue;
          e.measure();
          sum.f3 += 3.0 - e.top_cosine[0] - e.top_cosine[1] - e.top_cosine[2];
          sum.barrier += e.energy({0.0, 1.0});
        }
        return sum;
      },
      add);
  value.barrier += sum_of_folds(y, context);
  value.f3 *= element_weight;
  value.barrier *= element_weight;
  const ObjectiveValue own = parallel_reduce(
      context, size(), ObjectiveValue{},
      [&](std::size_t begin, std::size_t end) {
        ObjectiveValue sum;
        for (std::size_t i = begin; i < end; ++i) {
          if (!is_moving_[i]) continue;
          sum.f1 += n_incident_[i] - dot(normal_sum_[i], y[i] / norm(y[i]));
          sum.f2 += mirror_share_[i] * (1.0 - dot(y[i], normal_[i]));
          sum.f4 += membrane(i, normal_height(i, y[i]), y).share;
        }
        return sum;
      },
      add);
  value.f1 = element_weight * own.f1;
  value.f2 = vertex_weight() * own.f2;
  value.f4 = own.f4;
  value.total = value.f1 + weights_.height * value.f2 + weights_.top * value.f3 + value.f4 + weights_.barrier * value.barrier;
  return value;
}

}  // namespace sterna::volmesh
