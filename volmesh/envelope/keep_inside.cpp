#include "volmesh/envelope/keep_inside.h"

#include <algorithm>

#include "geom/base/parallel.h"
#include "geom/mesh/layer_room.h"
#include "volmesh/envelope/keep_distance.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

constexpr int k_inside_bisections = 12;     ///< number of halvings; the result is within 0.02 % of the height
constexpr int k_chord_steps = 4;            ///< number of steps; each reduces the error of the chord's length by the square of the angle of rotation
constexpr double k_seat_tolerance = 1e-12;  ///< fraction of the body length: rounding error of a point on the surface
constexpr int k_max_seat_rounds = 24;
/// Factor on the height if the point on the surface is not possible; after 24 rounds, at 2e-4 of the height, the vertex collapses.
constexpr double k_seat_shrink = 0.7;

const ConstraintSurface& surface_of(const LayerBase& base, VertexId v) { return *base.surfaces[static_cast<std::size_t>(base.constraint[v].on[0])]; }

bool is_seated(const LayerBase& base, const Envelope& envelope, VertexId v) {
  return std::abs(surface_of(base, v).inside_distance(envelope.point(base.wall, v))) <= k_seat_tolerance * base.body_length;
}

/// Turns the chord until its end is on the surface. The height is constant to second order.
void seat(const LayerBase& base, VertexId v, Envelope& envelope) {
  const Point p = base.wall.points[v];
  for (int step = 0; step < k_chord_steps; ++step) {
    const Vec3 chord = surface_of(base, v).closest(p + envelope.height[v] * envelope.direction[v]) - p;
    if (norm2(chord) == 0.0) return;
    envelope.direction[v] = normalized(chord);
    if (step + 1 == k_chord_steps) envelope.height[v] = norm(chord);
  }
}

}  // namespace

bool is_inside(const LayerBase& base, VertexId v, const Vec3& growth) {
  const Point p = base.wall.points[v];
  for (std::size_t k = 0; k < base.surfaces.size(); ++k) {
    if (base.constraint[v].is_on(k) || !base.concerns(k, v)) continue;
    const double own = base.surfaces[k]->inside_distance(p);
    if (own <= 0.0 && !base.near.empty()) continue;  // the vertex lies beyond the border of the surface to which this plane belongs
    const double there = base.surfaces[k]->inside_distance(p + growth);
    // Half of the gap that a body and its mirror image leave between their layers is required.
    if (there <= 0.0 || there < std::min(k_kept_share * own, 0.5 * k_kept_edges * base.mean_edge[v])) return false;
  }
  return true;
}

void keep_inside(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  if (base.surfaces.empty()) return;
  const EnvelopeScale scale = scale_of(base, options);
  parallel_for(context, base.wall.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    const Vec3 growth = envelope.height[v] * envelope.direction[v];
    if (envelope.is_collapsed(v) || is_inside(base, v, growth)) return;
    double inside = 0.0, beyond = 1.0;
    for (int step = 0; step < k_inside_bisections; ++step) {
      const double middle = 0.5 * (inside + beyond);
      (is_inside(base, v, middle * growth) ? inside : beyond) = middle;
    }
    lower(envelope, v, inside * envelope.height[v], HeightLimit::gap, scale);
  });
}

void seat_on_surfaces(const LayerBase& base, const EnvelopeOptions& options, Collider* collider, Envelope& envelope, const RunContext& context) {
  const EnvelopeScale scale = scale_of(base, options);
  for (int round = 0;; ++round) {
    std::vector<VertexId> off;
    for (const VertexId v : base.constraint.ids())
      if (base.constraint[v].freedom == Freedom::surface && !envelope.is_collapsed(v) && !is_seated(base, envelope, v)) off.push_back(v);
    if (off.empty()) return;
    Envelope proposal = envelope;
    for (const VertexId v : off) seat(base, v, proposal);
    if (collider) apply_where_clear(base, *collider, envelope, proposal, context);
    else apply_where_valid(base, envelope, proposal, context);
    bool has_lowered = false;
    for (const VertexId v : off) {
      if (is_seated(base, envelope, v)) continue;
      lower(envelope, v, round < k_max_seat_rounds ? k_seat_shrink * envelope.height[v] : 0.0, HeightLimit::warp, scale);
      has_lowered = true;
    }
    if (!has_lowered) return;
    unwarp(base, options, HeightLimit::warp, envelope, context);
    if (collider) retract_collisions(base, options, *collider, envelope, context);
  }
}

}  // namespace sterna::volmesh
