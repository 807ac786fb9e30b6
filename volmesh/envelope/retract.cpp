#include "volmesh/envelope/retract.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/math/bvh.h"
#include "geom/math/intersect.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

constexpr double k_look_ahead = 2.5;       ///< heights along the growth line within which an opposing wall matters
constexpr double k_gap_share = 0.95;       ///< of the gap that both layers together may fill; the rest is for tets
constexpr double k_opposing_cosine = 0.7;  ///< walls that face the line within 45 degrees oppose it; the rest is left to the exact test
constexpr int k_pair_bisections = 10;    ///< halvings: 0.1 % of the height
constexpr double k_pair_reserve = 0.98;  ///< of the largest scale at which a pair of triangles is clear
constexpr double k_clearance_factor = 0.95;  ///< once nothing collides: leaves a gap for tets between retracted layers
constexpr int k_regrow_rounds = 6;
constexpr double k_regrow_clearance = 1.06;  ///< regrown heights stay clear even when this much taller
constexpr int k_level_sweeps = 3;

/// Parameter along the segment p + s d (s in [0, 1]) where it meets the triangle, or a negative number. Rounding does not matter: heights keep a reserve.
double segment_hit(const Point& p, const Vec3& d, const std::array<Point, 3>& t) {
  const Vec3 e1 = t[1] - t[0], e2 = t[2] - t[0];
  const Vec3 q = cross(d, e2);
  const double det = dot(e1, q);
  if (det == 0.0) return -1.0;
  const Vec3 s = p - t[0];
  const double u = dot(s, q) / det;
  const Vec3 r = cross(s, e1);
  const double v = dot(d, r) / det;
  if (u < 0.0 || v < 0.0 || u + v > 1.0) return -1.0;
  const double hit = dot(e2, r) / det;
  return hit <= 1.0 ? hit : -1.0;
}

struct GapHit {
  VertexId vertex;
  TriangleId opposite;
  double gap;    ///< m along the growth line
  double cosine; ///< between the line and the opposing wall's inward normal
};

std::vector<GapHit> find_gaps(const LayerBase& base, const Envelope& envelope, const RunContext& context) {
  std::vector<Box> boxes(base.wall.n_triangles());
  parallel_for(context, boxes.size(), [&](std::size_t i) {
    for (const Point& p : corners(base.wall, TriangleId(i))) boxes[i].add(p);
  });
  const BoxTree tree(boxes, context);
  using List = std::vector<GapHit>;
  return parallel_reduce(
      context, base.wall.n_vertices(), List{},
      [&](std::size_t begin, std::size_t end) {
        List hits;
        for (std::size_t i = begin; i < end; ++i) {
          const VertexId v(i);
          if (envelope.is_collapsed(v)) continue;
          const Point p = base.wall.points[v];
          const Vec3 look = (k_look_ahead * envelope.height[v]) * envelope.direction[v];
          Box box;
          box.add(p);
          box.add(p + look);
          GapHit nearest{v, {}, 0.0, 0.0};
          double first = 2.0;
          tree.visit_overlaps(box, [&](std::uint32_t item) {
            const TriangleId t(item);
            const double cosine = -dot(base.unit_normal[t], envelope.direction[v]);
            if (cosine < k_opposing_cosine) return true;
            const TriangleVertices& own = base.wall.triangles[t];
            if (own[0] == v || own[1] == v || own[2] == v) return true;
            const double s = segment_hit(p, look, corners(base.wall, t));
            if (s < 0.0 || s > first || (s == first && nearest.opposite < t)) return true;
            first = s;
            nearest = {v, t, s * norm(look), cosine};
            return true;
          });
          if (nearest.opposite.is_valid()) hits.push_back(nearest);
        }
        return hits;
      },
      [](List a, List b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
}

}  // namespace

void share_gaps(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  const EnvelopeScale scale = scale_of(options);
  const std::vector<GapHit> hits = find_gaps(base, envelope, context);
  const Column<VertexId, double> asked = envelope.height;
  for (const GapHit& hit : hits) {
    const TriangleVertices& opposite = base.wall.triangles[hit.opposite];
    const double theirs = std::max({asked[opposite[0]], asked[opposite[1]], asked[opposite[2]]}) / hit.cosine;
    const double share = k_gap_share * hit.gap / (asked[hit.vertex] + theirs);
    if (share >= 1.0) continue;
    lower(envelope, hit.vertex, share * asked[hit.vertex], HeightLimit::gap, scale);
    for (const VertexId v : opposite) lower(envelope, v, share * asked[v], HeightLimit::gap, scale);
  }
  if (hits.empty()) return;
  level_steps(base, options, k_level_sweeps, HeightLimit::gap, envelope, context);
  unwarp(base, options, HeightLimit::warp, envelope, context);
}

EnvelopeSurface envelope_surface(const LayerBase& base, const Envelope& envelope, const RunContext& context) {
  EnvelopeSurface surface;
  const std::size_t n = base.wall.n_vertices();
  surface.points.resize(2 * n);
  surface.triangles.resize(base.wall.n_triangles());
  parallel_for(context, n, [&](std::size_t i) {
    const VertexId v(i);
    surface.points[i] = base.wall.points[v];
    surface.points[n + i] = envelope.point(base.wall, v);
  });
  parallel_for(context, surface.triangles.size(), [&](std::size_t i) {
    const TriangleVertices& v = base.wall.triangles[TriangleId(i)];
    for (std::size_t k = 0; k < 3; ++k)
      surface.triangles[i][k] = v[k].value() + (envelope.is_collapsed(v[k]) ? 0u : static_cast<std::uint32_t>(n));
  });
  return surface;
}

namespace {

/// Triangles that may collide after the vertices in `changed` moved: those with such a vertex, and all whose boxes meet one of them.
std::vector<std::uint32_t> neighbourhood(const EnvelopeSurface& surface, const LayerBase& base, const Column<VertexId, std::uint8_t>& changed,
                                         const RunContext& context) {
  const auto box_of = [&](std::size_t t) {
    Box box;
    for (const std::uint32_t p : surface.triangles[t]) box.add(surface.points[p]);
    return box;
  };
  std::vector<Box> boxes;
  for (const TriangleId t : base.wall.triangles.ids()) {
    const TriangleVertices& v = base.wall.triangles[t];
    if (changed[v[0]] || changed[v[1]] || changed[v[2]]) boxes.push_back(box_of(t.index()));
  }
  std::vector<std::uint32_t> near;
  if (boxes.empty()) return near;
  const BoxTree tree(boxes, context);
  std::vector<std::uint8_t> is_near(surface.triangles.size(), 0);
  parallel_for(context, is_near.size(), [&](std::size_t t) {
    tree.visit_overlaps(box_of(t), [&](std::uint32_t) {
      is_near[t] = 1;
      return false;
    });
  });
  for (std::uint32_t t = 0; t < is_near.size(); ++t)
    if (is_near[t]) near.push_back(t);
  return near;
}

/// Largest common share of their heights at which two envelope triangles are clear of each other.
double clear_share(const LayerBase& base, const Envelope& envelope, const std::array<std::uint32_t, 2>& pair) {
  const auto crosses_at = [&](double share) {
    std::vector<Vec3> points;
    std::vector<VertexId> known;
    std::array<std::array<std::uint32_t, 3>, 2> triangle;
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId v = base.wall.triangles[TriangleId(pair[i])][k];
        const auto found = std::find(known.begin(), known.end(), v);
        triangle[i][k] = static_cast<std::uint32_t>(found - known.begin());
        if (found != known.end()) continue;
        known.push_back(v);
        points.push_back(base.wall.points[v] + (share * envelope.height[v]) * envelope.direction[v]);
      }
    }
    return triangles_cross(points, triangle[0], triangle[1]);
  };
  double clear = 0.0, crossing = 1.0;
  for (int step = 0; step < k_pair_bisections; ++step) {
    const double middle = 0.5 * (clear + crossing);
    (crosses_at(middle) ? crossing : clear) = middle;
  }
  return clear;
}

/// Pairs of crossing envelope triangles around the vertices of `recheck`, when the `changed` vertices are at `stretch` times their height.
std::vector<std::array<std::uint32_t, 2>> crossings_near(const LayerBase& base, const Envelope& envelope, const Column<VertexId, std::uint8_t>& recheck,
                                                         const Column<VertexId, std::uint8_t>& changed, double stretch, const RunContext& context) {
  EnvelopeSurface surface = envelope_surface(base, envelope, context);
  const std::size_t n = base.wall.n_vertices();
  if (stretch != 1.0) {
    for (const VertexId v : changed.ids())
      if (changed[v]) surface.points[n + v.index()] = base.wall.points[v] + (stretch * envelope.height[v]) * envelope.direction[v];
  }
  const std::vector<std::uint32_t> items = neighbourhood(surface, base, recheck, context);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const std::uint32_t t : items) triangles.push_back(surface.triangles[t]);
  CrossingPairs crossings = find_crossings(surface.points, triangles, context);
  for (auto& pair : crossings.pairs) pair = {items[pair[0]], items[pair[1]]};
  return std::move(crossings.pairs);
}

Column<VertexId, std::uint8_t> changed_vertices(const Envelope& before, const Envelope& after) {
  Column<VertexId, std::uint8_t> changed(before.height.size());
  for (const VertexId v : changed.ids()) changed[v] = after.height[v] != before.height[v] || !(after.direction[v] == before.direction[v]) ? 1 : 0;
  return changed;
}

}  // namespace

void apply_where_clear(const LayerBase& base, Envelope& envelope, const Envelope& proposal, const RunContext& context) {
  Envelope trial = envelope;
  apply_where_valid(base, trial, proposal, context);
  Column<VertexId, std::uint8_t> changed = changed_vertices(envelope, trial);
  Column<VertexId, std::uint8_t> recheck = changed;
  while (true) {
    Envelope next = trial;
    Column<VertexId, std::uint8_t> reverted(changed.size(), 0);
    bool has_reverted = false;
    for (const auto& pair : crossings_near(base, trial, recheck, changed, k_regrow_clearance, context)) {
      for (const std::uint32_t item : pair) {
        for (const VertexId v : base.wall.triangles[TriangleId(item)]) {
          if (!changed[v]) continue;
          next.height[v] = envelope.height[v];
          next.direction[v] = envelope.direction[v];
          reverted[v] = 1;
          has_reverted = true;
        }
      }
    }
    if (!has_reverted) break;
    // Going back may spoil an element beside it, whose vertices then go back too; only what went back needs another look.
    trial = envelope;
    apply_where_valid(base, trial, next, context, &reverted);
    const Column<VertexId, std::uint8_t> still_changed = changed_vertices(envelope, trial);
    for (const VertexId v : changed.ids()) recheck[v] = changed[v] && !still_changed[v] ? 1 : 0;
    changed = still_changed;
  }
  envelope = std::move(trial);
}

void regrow_clear(const LayerBase& base, Envelope& envelope, const RunContext& context) {
  for (int round = 0; round < k_regrow_rounds; ++round) apply_where_clear(base, envelope, raised(base, envelope, round, context), context);
}

void retract_collisions(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  const EnvelopeScale scale = scale_of(options);
  const std::size_t n = base.wall.n_vertices();
  Column<VertexId, std::uint8_t> changed(n, 1), is_retracted(n, 0);
  bool needs_clearance = false;
  for (int sweep = 0;; ++sweep) {
    const std::vector<std::array<std::uint32_t, 2>> pairs = crossings_near(base, envelope, changed, changed, 1.0, context);
    context.progress(static_cast<double>(sweep) / (sweep + 5.0));
    const Column<VertexId, double> before = envelope.height;
    if (pairs.empty()) {
      if (!needs_clearance) return;
      // One more reduction of everything that was retracted; it may bring something else together, so look once more.
      needs_clearance = false;
      for (const VertexId v : is_retracted.ids())
        if (is_retracted[v]) lower(envelope, v, k_clearance_factor * envelope.height[v], HeightLimit::collision, scale);
    } else {
      context.debug("layers collide in " + std::to_string(pairs.size()) + " pairs of triangles");
      std::vector<double> share(pairs.size(), 0.0);
      if (sweep < options.max_retract_sweeps)
        parallel_for(context, share.size(), [&](std::size_t i) { share[i] = k_pair_reserve * clear_share(base, envelope, pairs[i]); }, 16);
      for (std::size_t i = 0; i < share.size(); ++i) {
        for (const std::uint32_t item : pairs[i]) {
          for (const VertexId v : base.wall.triangles[TriangleId(item)]) {
            is_retracted[v] = 1;
            lower(envelope, v, share[i] * before[v], HeightLimit::collision, scale);
          }
        }
      }
      needs_clearance = sweep < options.max_retract_sweeps;
    }
    for (const VertexId v : changed.ids()) changed[v] = envelope.height[v] != before[v] ? 1 : 0;
    unwarp(base, options, HeightLimit::warp, envelope, context, &changed);
    for (const VertexId v : changed.ids()) changed[v] = envelope.height[v] != before[v] ? 1 : 0;
  }
}

}  // namespace sterna::volmesh
