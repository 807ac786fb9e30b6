#include "volmesh/envelope/untangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

/// Lines that converge by less than this do not meet within any layer (1e6 edge lengths away).
constexpr double k_parallel = 1e-6;
constexpr int k_untangle_smoothing_sweeps = 3;
constexpr int k_max_unwarp_rounds = 400;
constexpr int k_bisection_steps = 12;     ///< halvings in log h: 1 % of the height over four decades
constexpr double k_smallest_scale = 1e-5; ///< of the largest height of an element: where its bisection starts
constexpr double k_reserve = 0.98;        ///< keep a little below the largest valid height, so that neighbours need not move again
constexpr double k_regrow_share = 0.97;   ///< of the height at which growth lines meet that regrowth may reach
constexpr int k_regrow_rounds = 12;
constexpr double k_regrow_factor = 1.3;   ///< largest growth of a height in the first round; later rounds try less, so that what fails at first gets its share
constexpr double k_regrow_decay = 0.75;   ///< of the growth, from round to round
constexpr double k_step_gradient = 1.0;   ///< slope along edges that may stand beside lowered places

/// The element with its tallest corners cut to `height`.
MacroElement cut(MacroElement element, double height) {
  for (double& h : element.height) h = std::min(h, height);
  return element;
}

/// Largest height to which the tallest corners must be cut for the element to be valid; 0 when no height helps.
double valid_cut(const MacroElement& element) {
  const double tallest = std::max({element.height[0], element.height[1], element.height[2]});
  if (!is_macro_valid(cut(element, k_smallest_scale * tallest))) return 0.0;
  double valid = k_smallest_scale, invalid = 1.0;
  for (int step = 0; step < k_bisection_steps; ++step) {
    const double middle = std::sqrt(valid * invalid);
    (is_macro_valid(cut(element, middle * tallest)) ? valid : invalid) = middle;
  }
  return valid * tallest;
}

/// Corners of an element that no height makes valid and that must collapse: those whose direction does not rise from the triangle; all if each does.
void collapse_corners(const LayerBase& base, TriangleId t, const EnvelopeScale& scale, HeightLimit reason, Envelope& envelope) {
  bool has_collapsed = false;
  for (const VertexId v : base.wall.triangles[t]) {
    if (envelope.is_collapsed(v) || dot(base.unit_normal[t], envelope.direction[v]) > 0.0) continue;
    lower(envelope, v, 0.0, HeightLimit::invisible, scale);
    has_collapsed = true;
  }
  if (has_collapsed) return;
  for (const VertexId v : base.wall.triangles[t]) lower(envelope, v, 0.0, reason, scale);
}

}  // namespace

std::array<double, 2> edge_height_limits(const Point& p1, const Vec3& d1, const Point& p2, const Vec3& d2) {
  const Vec3 e = p2 - p1;
  const double beta1 = angle_between(e, d1);
  const double beta2 = angle_between(-e, d2);
  const double gamma = std::numbers::pi - beta1 - beta2;
  constexpr double k_never = std::numeric_limits<double>::infinity();
  if (gamma <= k_parallel) return {k_never, k_never};
  const double scale = norm(e) / std::sin(gamma);
  return {scale * std::sin(beta2), scale * std::sin(beta1)};
}

// Only downwards: a lowered height is reached by a slope and not by a step.
void level_steps(const LayerBase& base, const EnvelopeOptions& options, int sweeps, HeightLimit reason, Envelope& envelope,
                 const RunContext& context) {
  const EnvelopeScale scale = scale_of(options);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    Column<VertexId, double> bound = envelope.height;
    parallel_for(context, bound.size(), [&](std::size_t i) {
      const VertexId v(i);
      for (const VertexId other : base.topology.neighbours(v)) {
        if (envelope.is_collapsed(other)) continue;
        bound[v] = std::min(bound[v], envelope.height[other] + k_step_gradient * distance(base.wall.points[v], base.wall.points[other]));
      }
    });
    for (const VertexId v : bound.ids())
      if (bound[v] < envelope.height[v]) lower(envelope, v, bound[v], reason, scale);
  }
}

void untangle_edges(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  const EnvelopeScale scale = scale_of(options);
  const std::size_t n = base.wall.n_vertices();
  Column<VertexId, std::uint8_t> is_limited(n, 0);
  Column<VertexId, double> limit(n);
  parallel_for(context, n, [&](std::size_t i) {
    const VertexId v(i);
    double lowest = envelope.height[v];
    for (const VertexId other : base.topology.neighbours(v)) {
      if (envelope.is_collapsed(other)) continue;
      lowest = std::min(lowest, options.untangle_share * edge_height_limits(base.wall.points[v], envelope.direction[v],
                                                                            base.wall.points[other], envelope.direction[other])[0]);
    }
    limit[v] = lowest;
    is_limited[v] = lowest < envelope.height[v];
  });
  for (const VertexId v : limit.ids()) {
    if (!is_limited[v]) continue;
    lower(envelope, v, limit[v], HeightLimit::untangle, scale);
    // The heights that regrow() may try: nearer to the meeting point, but there every wedge is tested.
    envelope.cap[v] = std::min(envelope.cap[v], k_regrow_share / options.untangle_share * limit[v]);
  }
  level_steps(base, options, k_untangle_smoothing_sweeps, HeightLimit::untangle, envelope, context);
}

void unwarp(const LayerBase& base, const EnvelopeOptions& options, HeightLimit reason, Envelope& envelope, const RunContext& context,
            const Column<VertexId, std::uint8_t>* suspects) {
  const EnvelopeScale scale = scale_of(options);
  const std::size_t n = base.wall.n_vertices();
  Column<VertexId, std::uint8_t> dirty = suspects ? *suspects : Column<VertexId, std::uint8_t>(n, 1);
  for (int round = 0; round < k_max_unwarp_rounds; ++round) {
    const std::vector<TriangleId> bad = invalid_macros(base, envelope, context, &dirty);
    if (bad.empty()) return;
    std::vector<double> bound(bad.size());
    parallel_for(context, bad.size(), [&](std::size_t i) { bound[i] = valid_cut(macro_element(base, envelope, bad[i])); }, 64);
    dirty.assign(n, 0);
    for (std::size_t i = 0; i < bad.size(); ++i) {
      const TriangleVertices& vertices = base.wall.triangles[bad[i]];
      for (const VertexId v : vertices) dirty[v] = 1;
      if (bound[i] == 0.0) {
        collapse_corners(base, bad[i], scale, reason, envelope);
        continue;
      }
      for (const VertexId v : vertices) lower(envelope, v, k_reserve * bound[i], reason, scale);
    }
  }
  throw Error({.code = ErrorCode::envelope_failed,
               .attempted = "reducing warped elements of the layer",
               .problem = "no valid heights after " + std::to_string(k_max_unwarp_rounds) + " rounds",
               .hint = "report this surface"});
}

Envelope raised(const LayerBase& base, const Envelope& envelope, int round, const RunContext& context) {
  const double factor = 1.0 + (k_regrow_factor - 1.0) * std::pow(k_regrow_decay, round);
  Envelope proposal = envelope;
  parallel_for(context, base.wall.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    if (envelope.is_collapsed(v)) return;
    double h = std::min({envelope.target[v], envelope.cap[v], factor * envelope.height[v]});
    for (const VertexId other : base.topology.neighbours(v)) {
      const double bound = envelope.height[other] + k_step_gradient * distance(base.wall.points[v], base.wall.points[other]);
      h = std::min(h, bound);
    }
    if (h > envelope.height[v]) proposal.height[v] = h;
  });
  return proposal;
}

void regrow(const LayerBase& base, Envelope& envelope, const RunContext& context) {
  for (int round = 0; round < k_regrow_rounds; ++round) apply_where_valid(base, envelope, raised(base, envelope, round, context), context);
}

}  // namespace sterna::volmesh
