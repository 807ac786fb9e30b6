#include "volmesh/envelope/initial.h"

#include <algorithm>
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

/// Largest field h <= h0 with |h_i - h_j| <= gradient |e_ij|: Dijkstra from the lowest heights up (a unique result, whatever the order).
void limit_gradient(const LayerBase& base, double gradient, Column<VertexId, double>& height) {
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto offer_neighbours = [&](VertexId v) {
    for (const VertexId other : base.topology.neighbours(v)) {
      const double bound = height[v] + gradient * distance(base.wall.points[v], base.wall.points[other]);
      if (bound >= height[other]) continue;
      height[other] = bound;
      queue.emplace(bound, other.value());
    }
  };
  for (const VertexId v : height.ids()) offer_neighbours(v);
  while (!queue.empty()) {
    const auto [h, index] = queue.top();
    queue.pop();
    if (const VertexId v(index); height[v] == h) offer_neighbours(v);
  }
}

}  // namespace

Vec3 pull_into_cone(const LayerBase& base, VertexId v, const Vec3& wanted, double cosine) {
  return pull_towards_visible(base, v, wanted, std::min(cosine, k_cone_share * base.visibility[v]));
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
    envelope.target[v] = std::min(envelope.eq1[v], thickness);
    envelope.direction[v] = pull_towards_visible(base, v, base.vertex_normal[v], k_start_cosine * base.visibility[v]);
  });
  limit_gradient(base, options.height_gradient, envelope.target);
  envelope.height = envelope.target;
  envelope.cap = envelope.target;
  for (const VertexId v : envelope.height.ids()) {
    if (base.visibility[v] > k_visible) continue;
    envelope.height[v] = 0.0;
    envelope.limit[v] = HeightLimit::invisible;
  }
  return envelope;
}

}  // namespace sterna::volmesh
