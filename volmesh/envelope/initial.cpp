#include "volmesh/envelope/initial.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "geom/base/parallel.h"
#include "volmesh/envelope/growth_law.h"

namespace sterna::volmesh {
namespace {

constexpr double k_default_thickness_share = 0.1;  ///< of the body length, when max_thickness is automatic
/// The start direction sees its faces at least this share of the best possible cosine.
constexpr double k_start_cosine = 0.7;
/// Directions may leave the best one until they see their faces at this share of the best cosine.
constexpr double k_cone_share = 0.5;
constexpr int k_pull_steps = 20;  ///< halvings: 1e-6 of the angle
/// Cosines below this are rounding: no direction sees all faces.
constexpr double k_visible = 1e-9;

/// The direction nearest to `wanted` on the way to the visible one whose worst cosine is at least `needed`.
/// \pre the visible direction itself satisfies `needed`.
Vec3 pull_towards_visible(const LayerBase& base, VertexId v, const Vec3& wanted, double needed) {
  if (base.worst_cosine(v, wanted) >= needed) return wanted;
  double inside = 1.0, outside = 0.0;
  Vec3 best = base.visible_direction[v];
  for (int step = 0; step < k_pull_steps; ++step) {
    const double middle = 0.5 * (inside + outside);
    const Vec3 d = normalized((1.0 - middle) * wanted + middle * base.visible_direction[v]);
    if (base.worst_cosine(v, d) >= needed) {
      inside = middle;
      best = d;
    } else {
      outside = middle;
    }
  }
  return best;
}

/// Largest value at c for which the linear function over the triangle (a, b, c) rises by at most `slope` per metre, with values ha, hb given: from inside
/// the triangle where the steepest rise comes from there (the eikonal update of Kimmel & Sethian 1998), else along the edges.
double slope_bound(const Point& a, double ha, const Point& b, double hb, const Point& c, double slope) {
  const double along_edges = std::min(ha + slope * distance(a, c), hb + slope * distance(b, c));
  const Vec3 base = b - a;
  const double length = norm(base);
  if (length == 0.0) return along_edges;
  const Vec3 x = base / length;
  const double rise = (hb - ha) / length;  // the function's derivative along the edge a-b
  if (std::abs(rise) >= slope) return along_edges;
  const Vec3 to_c = c - a;
  const double u = dot(to_c, x);
  const double height = norm(to_c - u * x);
  const double across = std::sqrt(slope * slope - rise * rise);
  const double foot = u - height * rise / across;  // where the line of steepest rise through c meets a-b
  const double value = ha + rise * u + across * height;
  return foot > 0.0 && foot < length && value >= std::max(ha, hb) ? value : along_edges;
}

/// Largest field h <= h0 whose tangential slope is at most `gradient` in every triangle, by fast marching: heights become final from the lowest up, and a
/// vertex is bounded by final ones only, so every height is visited once.
void limit_gradient(const LayerBase& base, double gradient, Column<VertexId, double>& height) {
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  Column<VertexId, std::uint8_t> is_final(height.size(), 0);
  const auto& points = base.wall.points;
  const auto offer = [&](VertexId v, double bound) {
    if (is_final[v] || bound >= height[v]) return;
    height[v] = bound;
    queue.emplace(bound, v.value());
  };
  const auto offer_corner = [&](VertexId v, VertexId b, VertexId c) {
    const double along_edge = height[v] + gradient * distance(points[v], points[c]);
    offer(c, is_final[b] ? slope_bound(points[v], height[v], points[b], height[b], points[c], gradient) : along_edge);
  };
  for (const VertexId v : height.ids()) queue.emplace(height[v], v.value());
  while (!queue.empty()) {
    const VertexId v(queue.top().second);
    queue.pop();
    if (is_final[v]) continue;
    is_final[v] = 1;
    for (const HalfedgeId h : base.topology.outgoing(v)) {
      const VertexId b = base.topology.to(h);
      const VertexId c = base.topology.from(previous(h));
      offer_corner(v, b, c);
      offer_corner(v, c, b);
    }
  }
}

}  // namespace

Vec3 pull_into_cone(const LayerBase& base, VertexId v, const Vec3& wanted, double cosine) {
  const Vec3 allowed = constrained(base.constraint[v], wanted);
  if (norm2(allowed) == 0.0) return base.visible_direction[v];
  return pull_towards_visible(base, v, allowed, std::min(cosine, k_cone_share * base.visibility[v]));
}

Envelope initial_envelope(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context) {
  const std::size_t n_vertices = base.wall.n_vertices();
  Envelope envelope;
  envelope.direction.resize(n_vertices);
  envelope.eq1.resize(n_vertices);
  envelope.target.resize(n_vertices);
  envelope.limit.assign(n_vertices, HeightLimit::none);
  const double thickness =
      is_automatic(options.max_thickness) ? k_default_thickness_share * base.body_length : options.max_thickness;
  parallel_for(context, n_vertices, [&](std::size_t i) {
    const VertexId v(i);
    const double r = growth_for_edge(options.first_height, base.mean_edge[v], options.max_growth, options.layers);
    envelope.eq1[v] = layer_height(options.first_height, r, options.layers);
    envelope.target[v] = base.constraint[v].freedom == Freedom::fixed ? 0.0 : std::min(envelope.eq1[v], thickness);
    envelope.direction[v] = pull_towards_visible(base, v, base.vertex_normal[v], k_start_cosine * base.visibility[v]);
  });
  limit_gradient(base, options.height_gradient, envelope.target);
  envelope.height = envelope.target;
  envelope.cap = envelope.target;
  const double least = std::min(scale_of(options).h_min, thickness);  // the rise from a fixed vertex starts below it
  for (const VertexId v : envelope.height.ids()) {
    if (base.constraint[v].freedom == Freedom::fixed || envelope.target[v] < least) {
      envelope.height[v] = 0.0;
      envelope.limit[v] = HeightLimit::fixed;
    }
    if (base.visibility[v] > k_visible) continue;
    envelope.height[v] = 0.0;
    envelope.limit[v] = HeightLimit::invisible;
  }
  return envelope;
}

}  // namespace sterna::volmesh
