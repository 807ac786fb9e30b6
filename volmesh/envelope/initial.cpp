#include "volmesh/envelope/initial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/parallel.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/envelope/multi_normal_taper.h"
#include "volmesh/envelope/wall_distance.h"

namespace sterna::volmesh {
namespace {

/// Smallest cosine between the start direction and the face normals, as a fraction of the best possible cosine.
constexpr double k_start_cosine = 0.7;
/// Smallest cosine between a direction pulled into the visibility cone and the face normals, as a fraction of the best cosine.
constexpr double k_cone_share = 0.5;
constexpr int k_pull_steps = 20;  ///< number of halvings; the result is within 1e-6 of the angle
/// Cosines below this value are rounding errors. There is then no direction from which all faces are visible.
constexpr double k_visible = 1e-9;

}  // namespace

Vec3 pull_towards_visible(const LayerBase& base, VertexId v, const Vec3& preferred, double needed) {
  if (base.worst_cosine(v, preferred) >= needed) return preferred;
  double inside = 1.0, outside = 0.0;
  Vec3 best = base.visible_direction[v];
  for (int step = 0; step < k_pull_steps; ++step) {
    const double middle = 0.5 * (inside + outside);
    const Vec3 d = normalized((1.0 - middle) * preferred + middle * base.visible_direction[v]);
    if (base.worst_cosine(v, d) >= needed) {
      inside = middle;
      best = d;
    } else {
      outside = middle;
    }
  }
  return best;
}

Vec3 pull_into_cone(const LayerBase& base, VertexId v, const Vec3& preferred, double cosine) {
  const Vec3 allowed = constrained(base.constraint[v], preferred);
  if (norm2(allowed) == 0.0) return base.visible_direction[v];
  return pull_towards_visible(base, v, allowed, std::min(cosine, k_cone_share * base.cone_visibility(v)));
}

namespace {

/// Growth lines of a multi-normal fan that is not open yet have at least this cosine with the face normals, if such a direction exists.
constexpr double k_taper_cosine = 0.2;

void taper_multi_normals(const LayerBase& base, Envelope& envelope) {
  if (base.ridges == nullptr) return;
  for (const VertexId v : base.wall.points.ids()) {
    const OpenedRidges::BaseVertex* const multi_normal = base.multi_normal_of(v);
    if (multi_normal == nullptr) continue;
    const double share = multi_normal_opening(*multi_normal, envelope.target[v]);
    const Vec3& open = envelope.direction[v];
    const double angle = angle_between(multi_normal->middle, open);
    const Vec3 across = normalized(open - dot(open, multi_normal->middle) * multi_normal->middle);
    if (share < 1.0 && norm2(across) > 0.0)
      envelope.direction[v] = pull_into_cone(base, v, std::cos(share * angle) * multi_normal->middle + std::sin(share * angle) * across, k_taper_cosine);
  }
}

/// Same as limit_gradient(), but with a larger slope beside free edges of wake sheets.
void limit_heights(const LayerBase& base, double gradient, Column<VertexId, double>& height) {
  for (const VertexId border : base.sheet_borders) height[border] = std::numeric_limits<double>::max();
  for (const VertexId border : base.sheet_borders)
    for (const VertexId v : base.topology.neighbours(border))
      height[v] = std::min(height[v], k_border_slope * distance(base.wall.points[border], base.wall.points[v]));
  limit_gradient(base, gradient, height);
  for (const VertexId border : base.sheet_borders) height[border] = 0.0;
}

}  // namespace

Envelope initial_envelope(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context) {
  const std::size_t n_vertices = base.wall.n_vertices();
  Envelope envelope;
  envelope.direction.resize(n_vertices);
  envelope.eq1.resize(n_vertices);
  envelope.target.resize(n_vertices);
  envelope.limit.assign(n_vertices, HeightLimit::none);
  const EnvelopeScale scale = scale_of(base, options);
  parallel_for(context, n_vertices, [&](std::size_t i) {
    const VertexId v(i);
    envelope.eq1[v] = scale.unlimited_height(v);
    envelope.target[v] = base.constraint[v].freedom == Freedom::fixed ? 0.0 : scale.requested_height(v);
    if (!is_automatic(options.max_relative_height)) envelope.target[v] = std::min(envelope.target[v], options.max_relative_height * base.mean_edge[v]);
    envelope.direction[v] = pull_towards_visible(base, v, base.vertex_normal[v], k_start_cosine * base.visibility[v]);
  });
  limit_heights(base, options.height_gradient, envelope.target);
  taper_multi_normals(base, envelope);
  envelope.height = envelope.target;
  envelope.cap = envelope.target;
  for (const VertexId v : envelope.height.ids()) {
    const double least = std::min(scale.h_min(v), scale.max_thickness(v));  // heights near a fixed vertex, which rise from zero, are below this value
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
