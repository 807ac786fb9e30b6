#include "volmesh/envelope/untangle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/base/parallel.h"
#include "geom/base/sort_unique.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

/// Growth lines that converge by less than this do not meet within any layer (they meet 1e6 edge lengths away).
constexpr double k_parallel = 1e-6;
constexpr int k_untangle_smoothing_sweeps = 3;
constexpr int k_lowering_rounds = 100;     ///< largest number of rounds of unwarp; 3 to 10 are usual, and elements that are still invalid afterwards collapse
constexpr int k_ring_sweeps = 3;           ///< number of rings over which the height rises again around a collapsed vertex
constexpr int k_bisection_steps = 12;      ///< number of halvings in log h; the result is within 1 % of the height over four decades
constexpr double k_smallest_scale = 1e-5;  ///< fraction of the largest height of an element at which its bisection starts
constexpr double k_reserve = 0.98;         ///< factor on the largest valid height, so that neighbours need not be lowered again
constexpr double k_regrow_share = 0.97;    ///< largest fraction of the height at which growth lines meet that regrowth may reach
constexpr int k_regrow_rounds = 12;
constexpr std::array<double, 4> k_regrow_factors = {1.3, 1.12, 1.05, 1.02};  ///< factors by which a height grows in one step, by the number of failures so far
constexpr double k_step_gradient = 1.0;                                      ///< largest slope along edges beside lowered locations
constexpr double k_ring_gradient = 0.5;                                      ///< largest slope from a collapsed vertex to the vertices around it

/// Returns the element with its tallest corners cut to `height`.
MacroElement cut(MacroElement element, double height) {
  for (double& h : element.height) h = std::min(h, height);
  return element;
}

/// Returns the largest height to which the tallest corners must be cut for the element to be valid; 0 if no height makes it valid.
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

/// Collapses corners of an element that no height makes valid: corners whose direction does not rise from the triangle, or all corners if each direction rises.
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

// Heights only fall, so that a lowered height is approached by a slope and not by a step.
void level_steps(const LayerBase& base, const EnvelopeOptions& options, int sweeps, HeightLimit reason, Envelope& envelope, const RunContext& context) {
  const EnvelopeScale scale = scale_of(base, options);
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
  const EnvelopeScale scale = scale_of(base, options);
  const std::size_t n = base.wall.n_vertices();
  Column<VertexId, std::uint8_t> is_limited(n, 0);
  Column<VertexId, double> limit(n);
  parallel_for(context, n, [&](std::size_t i) {
    const VertexId v(i);
    double lowest = envelope.height[v];
    for (const VertexId other : base.topology.neighbours(v)) {
      if (envelope.is_collapsed(other)) continue;
      lowest = std::min(lowest, options.untangle_share *
                                    edge_height_limits(base.wall.points[v], envelope.direction[v], base.wall.points[other], envelope.direction[other])[0]);
    }
    limit[v] = lowest;
    is_limited[v] = lowest < envelope.height[v];
  });
  for (const VertexId v : limit.ids()) {
    if (!is_limited[v]) continue;
    lower(envelope, v, limit[v], HeightLimit::untangle, scale);
    // Upper limit for regrow(). It is nearer to the meeting point, because every wedge is tested in regrow().
    envelope.cap[v] = std::min(envelope.cap[v], k_regrow_share / options.untangle_share * limit[v]);
  }
  level_steps(base, options, k_untangle_smoothing_sweeps, HeightLimit::untangle, envelope, context);
}

namespace {

/// Returns the edges of these triangles at which the envelope is folded too sharply. They are in ascending order, each given by its lower half-edge.
std::vector<HalfedgeId> closed_folds(const LayerBase& base, const EnvelopeShape& envelope, const std::vector<TriangleId>& triangles) {
  std::vector<HalfedgeId> closed;
  for (const TriangleId t : triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const HalfedgeId h = halfedge(t, corner);
      if (!is_fold_open(base, envelope, h)) closed.push_back(std::min(h, base.topology.twin(h)));
    }
  sort_unique(closed);
  return closed;
}

/// Returns the fraction of the heights at the edge's four vertices at which the fold is open. Near the wall the fold is as open as the wall.
double open_share(const LayerBase& base, const Envelope& envelope, HalfedgeId h) {
  const EdgeDiamond diamond = edge_diamond(base, h);
  const FoldPoints wall = wall_points(base, diamond), top = envelope_points(base, envelope, diamond);
  const FoldLimit limit = fold_limit(wall);
  double open = k_smallest_scale, closed = 1.0;
  for (int step = 0; step < k_bisection_steps; ++step) {
    const double middle = std::sqrt(open * closed);
    FoldPoints points = wall;
    for (std::size_t k = 0; k < 4; ++k) points[k] += middle * (top[k] - wall[k]);
    (fold_slack(fold_of(points), limit) > 0.0 ? open : closed) = middle;
  }
  return open;
}

/// Lowers all four vertices of folds that are too sharp. If only the vertices of the edge were lowered, the fold would become sharper.
std::vector<VertexId> lower_folds(const LayerBase& base, const std::vector<TriangleId>& bad, const EnvelopeScale& scale, HeightLimit reason, Envelope& envelope,
                                  const RunContext& context) {
  const std::vector<HalfedgeId> folds = closed_folds(base, envelope, bad);
  std::vector<double> share(folds.size());
  parallel_for(
      context, folds.size(), [&](std::size_t i) { share[i] = open_share(base, envelope, folds[i]); }, 64);
  std::vector<std::pair<VertexId, double>> raised_heights;
  for (std::size_t i = 0; i < folds.size(); ++i)
    for (const VertexId v : edge_diamond(base, folds[i])) raised_heights.push_back({v, k_reserve * share[i] * envelope.height[v]});
  std::vector<VertexId> lowered;
  for (const auto& [v, height] : raised_heights) {
    if (!(height < envelope.height[v])) continue;
    lower(envelope, v, height, reason, scale);
    lowered.push_back(v);
  }
  return lowered;
}

/// Lowers the corners of invalid elements and folds, or collapses them. Returns the lowered vertices, each once.
std::vector<VertexId> lower_elements(const LayerBase& base, const std::vector<TriangleId>& bad, bool must_collapse, const EnvelopeScale& scale,
                                     HeightLimit reason, Envelope& envelope, const RunContext& context) {
  std::vector<double> bound(bad.size(), 0.0);
  if (!must_collapse)
    parallel_for(
        context, bad.size(),
        [&](std::size_t i) {
          const MacroElement element = macro_element(base, envelope, bad[i]);
          bound[i] = is_macro_valid(element) ? std::numeric_limits<double>::infinity() : valid_cut(element);
        },
        64);
  std::vector<VertexId> lowered;
  if (!must_collapse) lowered = lower_folds(base, bad, scale, reason, envelope, context);
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const TriangleVertices& vertices = base.wall.triangles[bad[i]];
    const std::array<double, 3> before = {envelope.height[vertices[0]], envelope.height[vertices[1]], envelope.height[vertices[2]]};
    if (must_collapse) {
      for (const VertexId v : vertices) lower(envelope, v, 0.0, reason, scale);
    } else if (bound[i] == 0.0) {
      collapse_corners(base, bad[i], scale, reason, envelope);
    } else {
      for (const VertexId v : vertices) lower(envelope, v, k_reserve * bound[i], reason, scale);
    }
    for (std::size_t k = 0; k < 3; ++k)
      if (envelope.height[vertices[k]] != before[k]) lowered.push_back(vertices[k]);
  }
  sort_unique(lowered);
  return lowered;
}

/// Surrounds collapsed vertices, except those on free edges of wake sheets, by a ring of low vertices, from which the height rises by at most k_step_gradient.
/// Returns the lowered vertices. The ring is compressed (docs/method/envelope.md, "Warp"). If all growth lines have the same growth, the height rises by
/// k_ring_gradient instead. Growth lines a few first heights tall would have cells of a millionth of their neighbours' heights, and faces between stacked cells
/// would be inclined by 89.9 degrees.
std::vector<VertexId> surround_collapsed(const LayerBase& base, const std::vector<VertexId>& vertices, const EnvelopeScale& scale, Envelope& envelope) {
  std::vector<VertexId> all, front;
  for (const VertexId v : vertices) {
    if (!envelope.is_collapsed(v) || base.is_sheet_border(v)) continue;
    for (const VertexId other : base.topology.neighbours(v)) {
      const double rise = scale.has_common_growth() ? k_ring_gradient * distance(base.wall.points[v], base.wall.points[other]) : 0.0;
      const double bound = std::max(scale.compressed(other), rise);
      envelope.cap[other] = std::min(envelope.cap[other], bound);
      if (envelope.height[other] <= bound) continue;
      lower(envelope, other, bound, envelope.limit[v], scale);
      front.push_back(other);
    }
  }
  for (int sweep = 0; !front.empty(); ++sweep) {
    sort_unique(front);
    all.insert(all.end(), front.begin(), front.end());
    std::vector<VertexId> next;
    for (const VertexId v : front) {
      for (const VertexId other : base.topology.neighbours(v)) {
        const double bound = envelope.height[v] + k_step_gradient * distance(base.wall.points[v], base.wall.points[other]);
        if (sweep == k_ring_sweeps || envelope.height[other] <= bound) continue;
        lower(envelope, other, bound, envelope.limit[v], scale);
        next.push_back(other);
      }
    }
    front = std::move(next);
  }
  sort_unique(all);
  return all;
}

}  // namespace

std::vector<VertexId> unwarp(const LayerBase& base, const EnvelopeOptions& options, HeightLimit reason, Envelope& envelope, const RunContext& context,
                             const std::vector<VertexId>* suspects) {
  const EnvelopeScale scale = scale_of(base, options);
  std::vector<VertexId> all, around;
  const std::vector<VertexId>* looked_at = suspects;
  std::vector<VertexId> may_be_down;
  if (suspects) may_be_down = *suspects;
  else
    for (const VertexId v : envelope.height.ids()) may_be_down.push_back(v);
  for (int round = 0;; ++round) {
    const std::vector<TriangleId> bad = invalid_macros(base, envelope, context, looked_at);
    // Each round with must_collapse collapses a vertex, unless all elements are valid, so the loop terminates.
    around = bad.empty() ? surround_collapsed(base, may_be_down, scale, envelope)
                         : lower_elements(base, bad, round >= k_lowering_rounds, scale, reason, envelope, context);
    if (bad.empty()) may_be_down.clear();
    if (around.empty()) break;
    may_be_down.insert(may_be_down.end(), around.begin(), around.end());
    all.insert(all.end(), around.begin(), around.end());
    looked_at = &around;
  }
  sort_unique(all);
  return all;
}

ShapeChange raised(const LayerBase& base, const Envelope& envelope, const Column<VertexId, std::uint8_t>& n_failures, const RunContext& context) {
  ShapeChange all = parallel_reduce(
      context, base.wall.n_vertices(), ShapeChange{},
      [&](std::size_t begin, std::size_t end) {
        ShapeChange change;
        for (std::size_t i = begin; i < end; ++i) {
          const VertexId v(i);
          if (envelope.is_collapsed(v) || n_failures[v] >= k_regrow_factors.size()) continue;
          double h = std::min({envelope.target[v], envelope.cap[v], k_regrow_factors[n_failures[v]] * envelope.height[v]});
          if (h <= envelope.height[v]) continue;
          for (const VertexId other : base.topology.neighbours(v))
            h = std::min(h, envelope.height[other] + k_step_gradient * distance(base.wall.points[v], base.wall.points[other]));
          if (h <= envelope.height[v]) continue;
          change.vertices.push_back(v);
          change.height.push_back(h);
        }
        return change;
      },
      [](ShapeChange a, ShapeChange b) {
        a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
        a.height.insert(a.height.end(), b.height.begin(), b.height.end());
        return a;
      });
  all.direction.reserve(all.vertices.size());
  for (const VertexId v : all.vertices) all.direction.push_back(envelope.direction[v]);
  return all;
}

void count_failures(const std::vector<VertexId>& tried, const std::vector<VertexId>& done, Column<VertexId, std::uint8_t>& n_failures) {
  auto next = done.begin();
  for (const VertexId v : tried) {
    if (next != done.end() && *next == v) ++next;
    else ++n_failures[v];
  }
}

void regrow(const LayerBase& base, Envelope& envelope, const RunContext& context) {
  Column<VertexId, std::uint8_t> n_failures(envelope.height.size(), 0);
  for (int round = 0; round < k_regrow_rounds; ++round) {
    ShapeChange change = raised(base, envelope, n_failures, context);
    if (change.vertices.empty()) return;
    const std::vector<VertexId> tried = change.vertices;
    TrialChange trial(base, envelope, std::move(change), context);
    trial.take_back_invalid(tried);
    count_failures(tried, trial.vertices_in_force(), n_failures);
  }
}

}  // namespace sterna::volmesh
