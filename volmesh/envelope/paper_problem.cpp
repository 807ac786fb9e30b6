#include "volmesh/envelope/paper_problem.h"

#include <algorithm>

#include "geom/base/parallel.h"

namespace sterna::volmesh {
namespace {

/// Of h_u: no line leans further than 63 degrees from its vertex normal at full height.
constexpr double k_tangential_bound = 2.0;
/// g_1min of (6): the share of is_macro_valid (validity.cpp).
constexpr double k_min_area_share = 0.01;

}  // namespace

PaperProblem::PaperProblem(const LayerBase& base, const Envelope& start, const Column<VertexId, double>& h_u, double h_l, const RunContext& context)
    : base_(base),
      objective_(base, start, h_u, h_l, 0.0, {.height = 1.0, .top = 0.0, .barrier = 0.0}, context),
      frames_(base.wall.n_vertices()),
      y_(objective_.unknowns(start)),
      corner_gradient_(3 * base.wall.n_triangles()),
      is_violated_(base.wall.n_triangles(), 0) {
  h_u_.resize(frames_.size());
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    h_u_[i] = objective_.upper(i);
    if (!objective_.is_moving(i)) continue;
    Frame& frame = frames_[i];
    const TangentAxes tangents = tangent_axes(base.constraint[VertexId(i)], base.vertex_normal[VertexId(i)]);
    for (int k = 0; k < tangents.count; ++k) frame.axis[static_cast<std::size_t>(k)] = tangents.axis[static_cast<std::size_t>(k)];
    frame.axis[static_cast<std::size_t>(tangents.count)] = base.vertex_normal[VertexId(i)];
    frame.count = tangents.count + 1;
    frame.first = lower_.size();
    lower_.insert(lower_.end(), static_cast<std::size_t>(tangents.count), -k_tangential_bound);
    upper_.insert(upper_.end(), static_cast<std::size_t>(tangents.count), k_tangential_bound);
    lower_.push_back(objective_.lower_share(i));
    upper_.push_back(1.0);
  }
}

std::vector<double> PaperProblem::variables(const Envelope& envelope) const {
  const Vec3Field y = objective_.unknowns(envelope);
  std::vector<double> z(n_variables());
  for (std::size_t i = 0; i < frames_.size(); ++i)
    for (int k = 0; k < frames_[i].count; ++k) {
      const std::size_t j = frames_[i].first + static_cast<std::size_t>(k);
      z[j] = std::clamp(dot(y[i], frames_[i].axis[static_cast<std::size_t>(k)]), lower_[j], upper_[j]);
    }
  return z;
}

void PaperProblem::unpack(const double* z, const RunContext& context) {
  parallel_for(context, frames_.size(), [&](std::size_t i) {
    const Frame& frame = frames_[i];
    if (frame.count == 0) return;
    Vec3 sum;
    for (int k = 0; k < frame.count; ++k) sum += z[frame.first + static_cast<std::size_t>(k)] * frame.axis[static_cast<std::size_t>(k)];
    y_[i] = sum;
  });
}

void PaperProblem::pack_gradient(const Vec3Field& by_vertex, double* gradient, const RunContext& context) const {
  parallel_for(context, frames_.size(), [&](std::size_t i) {
    const Frame& frame = frames_[i];
    for (int k = 0; k < frame.count; ++k) gradient[frame.first + static_cast<std::size_t>(k)] = dot(by_vertex[i], frame.axis[static_cast<std::size_t>(k)]);
  });
}

void PaperProblem::store(const double* z, Envelope& envelope) const {
  Vec3Field y(frames_.size());
  for (std::size_t i = 0; i < frames_.size(); ++i)
    for (int k = 0; k < frames_[i].count; ++k) y[i] += z[frames_[i].first + static_cast<std::size_t>(k)] * frames_[i].axis[static_cast<std::size_t>(k)];
  objective_.store(y, envelope);
}

ObjectiveValue PaperProblem::objective(const double* z, double* gradient, const RunContext& context) {
  unpack(z, context);
  const ObjectiveValue value = objective_.evaluate(y_, gradient ? &gradient_ : nullptr, context);
  if (gradient) pack_gradient(gradient_, gradient, context);
  return value;
}

ConstraintSum PaperProblem::constraint(Kind kind, const double* z, double* gradient, const RunContext& context) {
  unpack(z, context);
  const auto& points = base_.wall.points;
  const ConstraintSum total = parallel_reduce(
      context, is_violated_.size(), ConstraintSum{},
      [&](std::size_t begin, std::size_t end) {
        ConstraintSum part;
        for (std::size_t t = begin; t < end; ++t) {
          is_violated_[t] = 0;
          if (!objective_.is_element(t)) continue;
          const TriangleVertices& v = base_.wall.triangles[TriangleId(t)];
          const Vec3& normal = base_.unit_normal[TriangleId(t)];
          Vec3* const out = corner_gradient_.data() + 3 * t;
          double g = 0.0;
          if (kind == Kind::inversion) {
            std::array<Vec3, 3> growth;
            for (std::size_t k = 0; k < 3; ++k) growth[k] = h_u_[v[k].index()] * y_[v[k].index()];
            const Vec3 a = points[v[1]] - points[v[0]] + (growth[1] - growth[0]);
            const Vec3 b = points[v[2]] - points[v[0]] + (growth[2] - growth[0]);
            const Vec3 scaled = normal / (2.0 * base_.area[TriangleId(t)]);  // n_w / |n_w|^2
            g = k_min_area_share - dot(scaled, cross(a, b));
            const Vec3 to_a = -cross(b, scaled), to_b = -cross(scaled, a);
            out[0] = h_u_[v[0].index()] * -(to_a + to_b);
            out[1] = h_u_[v[1].index()] * to_a;
            out[2] = h_u_[v[2].index()] * to_b;
          } else {
            std::size_t lowest = 0;
            for (std::size_t k = 1; k < 3; ++k)
              if (dot(y_[v[k].index()], normal) < dot(y_[v[lowest].index()], normal)) lowest = k;
            g = -dot(y_[v[lowest].index()], normal);
            for (std::size_t k = 0; k < 3; ++k) out[k] = k == lowest ? -normal : Vec3{};
          }
          if (!(g > 0.0)) continue;
          is_violated_[t] = 1;
          part.sum += g;
          ++part.n_violated;
        }
        return part;
      },
      [](ConstraintSum a, const ConstraintSum& b) {
        a.sum += b.sum;
        a.n_violated += b.n_violated;
        return a;
      });
  if (!gradient) return total;
  gradient_.resize(frames_.size());
  parallel_for(context, frames_.size(), [&](std::size_t i) {
    Vec3 sum;
    for (const HalfedgeId h : base_.topology.outgoing(VertexId(i)))
      if (is_violated_[h.index() / 3]) sum += corner_gradient_[h.index()];
    gradient_[i] = sum;
  });
  pack_gradient(gradient_, gradient, context);
  return total;
}

}  // namespace sterna::volmesh
