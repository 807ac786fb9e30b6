// Block coordinate descent for LayerObjective. Every vertex is a block of at most three unknowns.
#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/parallel.h"
#include "volmesh/envelope/layer_objective.h"

namespace sterna::volmesh {
namespace {

/// Largest number of halvings of a step that raises the objective; after that the vertex waits for changes of its neighbours.
constexpr int k_max_descent_halvings = 6;
constexpr std::size_t k_max_incident = 64;   ///< a vertex with more triangles than this does not move
constexpr double k_max_step = 0.5;           ///< largest step, in units of h_u
constexpr double k_sufficient = 1e-4;        ///< Armijo condition: required fraction of the predicted decrease
constexpr double k_min_turning_share = 0.2;  ///< smallest curvature against turning, as a fraction of the curvature for a vertex on a plane
constexpr std::size_t k_visit_chunk = 256;   ///< number of vertices of a colour per task; the visit of a vertex takes some microseconds

/// Solves (B^T H B) c = B^T r for the columns B = directions[0 .. n) by elimination. Pivoting is not needed, because H is positive definite. Returns B c.
Vec3 solve_within(const SymmetricBlock& h, const std::array<Vec3, 3>& directions, int n, const Vec3& r) {
  std::array<std::array<double, 4>, 3> a{};
  for (int i = 0; i < n; ++i) {
    const Vec3 row = h * directions[static_cast<std::size_t>(i)];
    for (int j = 0; j < n; ++j) a[i][j] = dot(row, directions[static_cast<std::size_t>(j)]);
    a[i][n] = dot(r, directions[static_cast<std::size_t>(i)]);
  }
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (int j = k; j <= n; ++j) a[i][j] -= factor * a[k][j];
    }
  Vec3 result;
  for (int k = n; k-- > 0;) {
    double c = a[k][n];
    for (int j = k + 1; j < n; ++j) c -= a[k][j] * a[j][n];
    a[k][n] = c / a[k][k];
    result += a[k][n] * directions[static_cast<std::size_t>(k)];
  }
  return result;
}

}  // namespace

/// Scratch data of a visit, for every incident element. There is one object per task, so that no memory is allocated per vertex.
struct LayerObjective::VisitScratch {
  std::vector<LayerElement> elements = std::vector<LayerElement>(k_max_incident);
  std::vector<std::array<Vec3, 2>> fixed = std::vector<std::array<Vec3, 2>>(k_max_incident);  ///< top edges minus the growth edge that moves
  std::vector<FoldPoints> fold_points;
  std::vector<std::size_t> fold_corner;
};

void LayerObjective::colour_vertices() {
  std::vector<std::uint8_t> colour(size(), 0);
  for (std::size_t i = 0; i < size(); ++i) {
    if (!is_moving_[i]) continue;
    std::uint64_t taken = 0;
    for (const VertexId other : base_.topology.neighbours(VertexId(i)))
      if (other.index() < i && is_moving_[other.index()]) taken |= std::uint64_t{1} << colour[other.index()];
    for (const std::uint32_t fold : folds_.at(i))
      for (const std::uint32_t other : folds_.corners(fold))
        if (other < i && is_moving_[other]) taken |= std::uint64_t{1} << colour[other];
    std::uint8_t c = 0;
    while (taken >> c & 1) ++c;
    colour[i] = c;
    if (colours_.size() <= c) colours_.resize(c + std::size_t{1});
    colours_[c].push_back(static_cast<std::uint32_t>(i));
  }
}

double LayerObjective::visit(std::size_t i, Vec3Field& y, VisitScratch& scratch) const {
  const VertexId v(i);
  const ElementWeights weights = element_weights();
  const double f1_weight = corner_weight();
  std::vector<LayerElement>& elements = scratch.elements;
  const double scale = h_u_[i];
  const Vec3 start = scale * y[i];
  std::size_t n = 0;
  for (const HalfedgeId h : base_.topology.outgoing(v)) {
    const TriangleId t = triangle_of(h);
    if (!is_element_[t.index()]) continue;
    LayerElement& e = elements[n];
    e.margins = margins_of(t.index());
    e.is_virtual = base_.is_virtual(t);
    e.n_wall = base_.unit_normal[t];
    e.wall_area2 = 2.0 * base_.area[t];
    const auto corner = static_cast<std::size_t>(corner_of(h));
    for (std::size_t k = 0; k < 2; ++k) {
      const VertexId other = base_.wall.triangles[t][(corner + 1 + k) % 3];
      const Vec3 g = h_u_[other.index()] * y[other.index()];
      e.e[k] = base_.wall.points[other] - base_.wall.points[v];
      scratch.fixed[n][k] = e.e[k] + g;
      e.set_growth(k + 1, g);
    }
    e.set_corners();
    ++n;
  }
  const std::span<const std::uint32_t> folds = folds_.at(i);
  std::vector<FoldPoints>& fold_points = scratch.fold_points;
  std::vector<std::size_t>& fold_corner = scratch.fold_corner;
  fold_points.resize(folds.size());
  fold_corner.resize(folds.size());
  for (std::size_t f = 0; f < folds.size(); ++f) {
    fold_points[f] = this->fold_points(folds[f], y);
    const LayerFolds::Corners& corners = folds_.corners(folds[f]);
    fold_corner[f] = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), static_cast<std::uint32_t>(i)) - corners.begin());
  }
  const Vec3& normal = normal_[i];
  /// Returns the part of the objective that depends on this vertex; infinite if an element is infeasible.
  const auto local_objective = [&](const Vec3& g) {
    double sum =
        f1_weight * (n_incident_[i] - dot(normal_sum_[i], g) / norm(g)) - height_weight(i) * dot(g, normal) / scale + membrane(i, dot(g, normal), y).energy;
    for (std::size_t m = 0; m < n; ++m) {
      LayerElement& e = elements[m];
      e.set_growth(0, g);
      e.top = {scratch.fixed[m][0] - g, scratch.fixed[m][1] - g};
      if (!(e.measure(least_quality_) > 0.0)) return std::numeric_limits<double>::infinity();
      sum += e.energy(weights);
    }
    for (std::size_t f = 0; f < folds.size(); ++f) {
      fold_points[f][fold_corner[f]] = base_.wall.points[v] + g;
      sum += weights.barrier * fold_energy(fold_of(fold_points[f]), folds[f]);
    }
    return sum;
  };
  const double before = local_objective(start);
  const double length = norm(start);
  const Vec3 u = start / length;
  const double seen = dot(normal_sum_[i], u);
  const Membrane even = membrane(i, dot(start, normal), y);
  Vec3 gradient = (-f1_weight / length) * (normal_sum_[i] - seen * u) + (even.slope - height_weight(i) / scale) * normal;
  SymmetricBlock hessian;
  const double turning = f1_weight * std::max(seen, k_min_turning_share * n_incident_[i]) / (length * length);
  hessian.add_identity(turning);
  hessian.add(-turning, u);
  hessian.add(even.curvature, normal);
  hessian.add(height_weight(i) / (scale * scale), u);  // f_2 is linear: this adds a curvature that limits the step along its slope to one h_u
  for (std::size_t m = 0; m < n; ++m) elements[m].differentiate_corner_0(weights, gradient, hessian);
  for (std::size_t f = 0; f < folds.size(); ++f) {
    const Fold shape = fold_of(fold_points[f]);
    const double slack = fold_slack(shape, folds_.limit(folds[f]));
    if (slack >= 1.0) continue;
    const Barrier b = barrier(slack, 1.0);
    const Vec3 d = fold_gradient(fold_points[f], shape)[fold_corner[f]] / folds_.limit(folds[f]).range;
    gradient += (weights.barrier * b.slope) * d;
    hessian.add(weights.barrier * b.curvature, d);
  }

  const TangentAxes tangents = tangent_axes(base_.constraint[v], normal);
  std::array<Vec3, 3> directions{};
  for (int k = 0; k < tangents.count; ++k) directions[static_cast<std::size_t>(k)] = tangents.axis[static_cast<std::size_t>(k)];
  directions[static_cast<std::size_t>(tangents.count)] = normal;
  const auto solve = [&](const Vec3& r) { return solve_within(hessian, directions, tangents.count + 1, r); };
  Vec3 step = solve(-gradient);
  const double target = dot(start + step, normal) / scale;
  if (target > 1.0 || target < h_l_share_[i]) {
    // This is the minimum of the model on the bound. The multiplier of the bound restores the missing height.
    const Vec3 lifted = solve(normal);
    step += ((std::clamp(target, h_l_share_[i], 1.0) - target) * scale / dot(lifted, normal)) * lifted;
  }
  const double step_length = norm(step);
  if (step_length > k_max_step * scale) step *= k_max_step * scale / step_length;
  const double predicted = dot(gradient, step);
  if (!(predicted < 0.0)) return 0.0;
  double share = 1.0;
  for (int halving = 0; halving <= k_max_descent_halvings; ++halving, share *= 0.5) {
    Vec3 next = (start + share * step) / scale;
    clamp(i, next);  // applies the lower limit of the length, and removes rounding errors
    if (!(local_objective(scale * next) <= before + k_sufficient * share * predicted)) continue;
    const double way = norm(next - y[i]);
    y[i] = next;
    return way;
  }
  return 0.0;
}

std::size_t LayerObjective::descend(Vec3Field& y, std::vector<std::uint8_t>& active, double tolerance, const RunContext& context) {
  if (colours_.empty()) colour_vertices();
  std::vector<std::uint8_t> has_moved(size(), 0);
  std::size_t n_visits = 0;
  for (const std::vector<std::uint32_t>& colour : colours_) {
    n_visits += parallel_reduce(
        context, colour.size(), std::size_t{0},
        [&](std::size_t begin, std::size_t end) {
          VisitScratch scratch;
          std::size_t n = 0;
          for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = colour[k];
            if (!active[i] || base_.topology.outgoing(VertexId(i)).size() > k_max_incident) continue;
            has_moved[i] = visit(i, y, scratch) > tolerance ? 1 : 0;
            ++n;
          }
          return n;
        },
        [](std::size_t a, std::size_t b) { return a + b; }, k_visit_chunk);
  }
  parallel_for(context, size(), [&](std::size_t i) {
    active[i] = 0;
    if (!is_moving_[i]) return;
    active[i] = has_moved[i];
    for (const VertexId other : base_.topology.neighbours(VertexId(i))) active[i] |= has_moved[other.index()];
    for (const std::uint32_t fold : folds_.at(i))
      for (const std::uint32_t other : folds_.corners(fold)) active[i] |= has_moved[other];
  });
  return n_visits;
}

}  // namespace sterna::volmesh
