// Steps of an evaluation: growth edges from the unknowns; f over the vertices; g over the elements. Few elements are violated. Their gradients are added in the
// order of their numbers, so that the sums do not depend on the number of threads.
#include "volmesh/envelope/paper_problem.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "volmesh/envelope/multi_normal_taper.h"

namespace sterna::volmesh {
namespace {

/// If the ratio of the bounds is less than this, the vertex is fixed (docs/method/optimisation.md, "Bounds").
constexpr double k_paper_bound_ratio = 1.05;
/// Range of the tangential unknowns in units of h_u, which is 63 degrees from the normal at full height. If the start is outside of this range, the range is
/// 1.5 times the distance of the start.
constexpr double k_tangent_reach = 2.0;
constexpr double k_tangent_reserve = 1.5;

bool is_standing(const Envelope& envelope, const TriangleVertices& v) {
  return !envelope.is_collapsed(v[0]) && !envelope.is_collapsed(v[1]) && !envelope.is_collapsed(v[2]);
}

}  // namespace

/// Gradient of one violated element with respect to the growth edges of its corners, 1/m.
struct PaperProblem::Violated {
  TriangleId triangle;
  std::array<Vec3, 3> gradient;
};

PaperProblem::PaperProblem(Borrowed<const LayerBase> base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, double g1_min,
                           const RunContext& context)
    : base_(base), g1_min_(g1_min), vertex2location_(base->wall.n_vertices(), k_none), upper_(h_u), growth_(base->wall.n_vertices()) {
  parallel_for(context, growth_.size(), [&](std::size_t i) { growth_[VertexId(i)] = start.height[VertexId(i)] * start.direction[VertexId(i)]; });
  for (const VertexId v : start.height.ids()) {
    if (start.is_collapsed(v) || base->constraint[v].freedom == Freedom::fixed || is_tapered(base, start, v)) continue;
    const auto around = base->topology.outgoing(v);
    if (std::all_of(around.begin(), around.end(), [&](HalfedgeId h) { return is_standing(start, base->wall.triangles[triangle_of(h)]); }))
      add_location(v, h_u[v], h_l);
  }
  for (const TriangleId t : base->wall.triangles.ids()) {
    const TriangleVertices& v = base->wall.triangles[t];
    if (is_standing(start, v) && (takes_part(v[0]) || takes_part(v[1]) || takes_part(v[2]))) elements_.push_back(t);
  }
}

void PaperProblem::add_location(VertexId v, double h_u, double h_l) {
  const VertexConstraint& constraint = base_.constraint[v];
  const Vec3 normal = constrained(constraint, base_.vertex_normal[v]);
  const double h = dot(growth_[v], normal);
  upper_[v] = std::max(h_u, h);
  if (!(h > 0.0) || upper_[v] < k_paper_bound_ratio * h_l) return;
  const TangentAxes tangent = tangent_axes(constraint, normal);
  Location location{.vertex = v, .first = static_cast<std::uint32_t>(n_unknowns_), .n_tangents = static_cast<std::uint8_t>(tangent.count), .h_u = upper_[v]};
  for (std::size_t k = 0; k < location.n_tangents; ++k) {
    location.axis[k] = tangent.axis[k];
    const double reach = std::max(k_tangent_reach, k_tangent_reserve * std::abs(dot(growth_[v], location.axis[k])) / location.h_u);
    bounds_.lower.push_back(-reach);
    bounds_.upper.push_back(reach);
  }
  location.axis[location.n_tangents] = normal;
  bounds_.lower.push_back(std::min(h, h_l) / location.h_u);
  bounds_.upper.push_back(1.0);
  for (const HalfedgeId half : base_.topology.outgoing(v)) {
    location.normal_sum += base_.unit_normal[triangle_of(half)];
    location.n_triangles += 1.0;
  }
  n_unknowns_ += location.n_tangents + 1u;
  vertex2location_[v] = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back(location);
}

Vec3 PaperProblem::growth(const Location& location, std::span<const double> z) {
  Vec3 g;
  for (std::size_t k = 0; k <= location.n_tangents; ++k) g += z[location.first + k] * location.axis[k];
  return g;
}

void PaperProblem::add_gradient(const Location& location, const Vec3& d, std::span<double> gradient) {
  for (std::size_t k = 0; k <= location.n_tangents; ++k) gradient[location.first + k] += dot(d, location.axis[k]);
}

std::vector<double> PaperProblem::unknowns(const Envelope& envelope) const {
  std::vector<double> z(n_unknowns_);
  for (const Location& location : vertices_) {
    const Vec3 g = (envelope.height[location.vertex] / location.h_u) * envelope.direction[location.vertex];
    for (std::size_t k = 0; k <= location.n_tangents; ++k) z[location.first + k] = dot(g, location.axis[k]);
  }
  return z;
}

void PaperProblem::store(std::span<const double> z, Envelope& envelope, const RunContext& context) const {
  parallel_for(context, vertices_.size(), [&](std::size_t i) {
    const Location& location = vertices_[i];
    Vec3 g = location.h_u * growth(location, z);
    const VertexConstraint& constraint = base_.constraint[location.vertex];
    const Point& base_point = base_.wall.points[location.vertex];
    if (constraint.freedom == Freedom::surface) g = base_.surfaces[static_cast<std::size_t>(constraint.on[0])]->closest(base_point + g) - base_point;
    envelope.height[location.vertex] = norm(g);
    envelope.direction[location.vertex] = normalized(g);
  });
}

std::span<double> PaperProblem::unknowns_of(VertexId v, std::span<double> z) const {
  if (!takes_part(v)) return {};
  const Location& location = vertices_[vertex2location_[v]];
  return z.subspan(location.first, location.n_tangents + 1u);
}

std::size_t PaperProblem::shrink_violated(std::span<double> z, double factor, const RunContext& context) const {
  std::vector<double> gradient(z.size());
  constraint(z, gradient, context);
  std::size_t n_shrunk = 0;
  for (const Location& location : vertices_) {
    bool could_repair = false;
    for (std::size_t k = 0; k <= location.n_tangents; ++k) could_repair = could_repair || gradient[location.first + k] != 0.0;
    double& height = z[location.first + location.n_tangents];
    const double shrunk = std::max(bounds_.lower[location.first + location.n_tangents], factor * height);
    if (!could_repair || !(shrunk < height)) continue;
    for (std::size_t k = 0; k < location.n_tangents; ++k) z[location.first + k] *= factor;
    height = shrunk;
    ++n_shrunk;
  }
  return n_shrunk;
}

PaperObjective PaperProblem::objective(std::span<const double> z, std::span<double> gradient, const RunContext& context) const {
  return objective({1.0, 1.0}, z, gradient, context);
}

PaperConstraint PaperProblem::constraint(std::span<const double> z, std::span<double> gradient, const RunContext& context) const {
  return constraint({1.0, 1.0}, z, gradient, context);
}

double PaperProblem::part(Part part, std::span<const double> z, std::span<double> gradient, const RunContext& context) const {
  switch (part) {
    case Part::f1: return objective({1.0, 0.0}, z, gradient, context).f1;
    case Part::f2: return objective({0.0, 1.0}, z, gradient, context).f2;
    case Part::g1: return constraint({1.0, 0.0}, z, gradient, context).g1;
    case Part::g2: return constraint({0.0, 1.0}, z, gradient, context).g2;
  }
  return 0.0;
}

PaperObjective PaperProblem::objective(const Weights& weights, std::span<const double> z, std::span<double> gradient, const RunContext& context) const {
  const double corner = 1.0 / (3.0 * static_cast<double>(std::max<std::size_t>(n_elements(), 1)));
  const double vertex = 1.0 / static_cast<double>(std::max<std::size_t>(n_vertices(), 1));
  PaperObjective sum = parallel_reduce(
      context, vertices_.size(), PaperObjective{},
      [&](std::size_t begin, std::size_t end) {
        PaperObjective own;
        for (std::size_t i = begin; i < end; ++i) {
          const Location& location = vertices_[i];
          const Vec3 g = growth(location, z);
          const double length = norm(g);
          const Vec3 u = g / length;
          const double seen = dot(location.normal_sum, u);
          own.f1 += location.n_triangles - seen;
          own.f2 += 1.0 - z[location.first + location.n_tangents];
          if (gradient.empty()) continue;
          const Vec3 d = (-weights.first * corner / length) * (location.normal_sum - seen * u);
          for (std::size_t k = 0; k <= location.n_tangents; ++k) gradient[location.first + k] = dot(d, location.axis[k]);
          gradient[location.first + location.n_tangents] -= weights.second * vertex;
        }
        return own;
      },
      [](PaperObjective a, const PaperObjective& b) {
        a.f1 += b.f1;
        a.f2 += b.f2;
        return a;
      });
  sum.f1 *= corner;
  sum.f2 *= vertex;
  return sum;
}

PaperConstraint PaperProblem::constraint(const Weights& weights, std::span<const double> z, std::span<double> gradient, const RunContext& context) const {
  parallel_for(context, vertices_.size(), [&](std::size_t i) { growth_[vertices_[i].vertex] = vertices_[i].h_u * growth(vertices_[i], z); });
  struct Partial {
    PaperConstraint sum;
    std::vector<Violated> violated;
  };
  const bool needs_gradient = !gradient.empty();
  const Partial all = parallel_reduce(
      context, elements_.size(), Partial{},
      [&](std::size_t begin, std::size_t end) {
        Partial own;
        for (std::size_t i = begin; i < end; ++i) {
          const TriangleId t = elements_[i];
          const TriangleVertices& v = base_.wall.triangles[t];
          const auto [p0, p1, p2] = corners(base_.wall, t);
          const Vec3 g0 = growth_[v[0]], g1 = growth_[v[1]], g2 = growth_[v[2]];
          const Vec3& n = base_.unit_normal[t];
          // Eq. (6): the cross products are twice the area vectors of both triangles, and |n_w|^2 cancels one of the factors.
          const Vec3 e1 = (p1 - p0) + (g1 - g0), e2 = (p2 - p0) + (g2 - g0);
          const double double_area = 2.0 * base_.area[t];
          const double first = g1_min_ - dot(n, cross(e1, e2)) / double_area;
          // Eq. (7).
          const std::array<double, 3> rise = {dot(g0, n) / upper_[v[0]], dot(g1, n) / upper_[v[1]], dot(g2, n) / upper_[v[2]]};
          const std::size_t lowest = static_cast<std::size_t>(std::min_element(rise.begin(), rise.end()) - rise.begin());
          const double second = -rise[lowest];
          if (!(first > 0.0) && !(second > 0.0)) continue;
          Violated bad{.triangle = t, .gradient = {}};
          if (first > 0.0) {
            own.sum.g1 += first;
            ++own.sum.n_violated;
            const Vec3 d1 = (-weights.first / double_area) * cross(e2, n), d2 = (-weights.first / double_area) * cross(n, e1);
            bad.gradient = {-d1 - d2, d1, d2};
          }
          if (second > 0.0) {
            own.sum.g2 += second;
            ++own.sum.n_violated;
            bad.gradient[lowest] += (-weights.second / upper_[v[lowest]]) * n;
          }
          if (needs_gradient) own.violated.push_back(bad);
        }
        return own;
      },
      [](Partial a, const Partial& b) {
        a.sum.g1 += b.sum.g1;
        a.sum.g2 += b.sum.g2;
        a.sum.n_violated += b.sum.n_violated;
        a.violated.insert(a.violated.end(), b.violated.begin(), b.violated.end());
        return a;
      });
  if (!needs_gradient) return all.sum;
  std::fill(gradient.begin(), gradient.end(), 0.0);
  for (const Violated& bad : all.violated) {
    const TriangleVertices& v = base_.wall.triangles[bad.triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      if (!takes_part(v[k])) continue;
      const Location& location = vertices_[vertex2location_[v[k]]];
      add_gradient(location, location.h_u * bad.gradient[k], gradient);
    }
  }
  return all.sum;
}

}  // namespace sterna::volmesh
