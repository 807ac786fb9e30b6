#include "volmesh/envelope/retract.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/math/bvh.h"
#include "geom/math/intersect.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

constexpr double k_look_ahead = 2.5;       ///< heights along the growth line within which an opposing wall matters
constexpr double k_gap_share = 0.8;        ///< of the gap that both layers together may fill; the rest is for tets
constexpr double k_opposing_cosine = 0.5;  ///< walls that face the line within 60 degrees oppose it
constexpr double k_retract_factor = 0.8;   ///< of the height of colliding vertices, each sweep
constexpr double k_ring_factor = 0.9;      ///< of the height of their neighbours
constexpr double k_clearance_factor = 0.85;  ///< once nothing collides: leaves a gap for tets between retracted layers
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

void retract_collisions(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  const EnvelopeScale scale = scale_of(options);
  Column<VertexId, std::uint8_t> is_retracted(base.wall.n_vertices(), 0);
  bool has_collided = false;
  for (int sweep = 0;; ++sweep) {
    const EnvelopeSurface surface = envelope_surface(base, envelope, context);
    const CrossingPairs crossings = find_crossings(surface.points, surface.triangles, context);
    context.progress(static_cast<double>(sweep) / (sweep + 5.0));
    if (crossings.total == 0) {
      if (!has_collided) return;
      // One more reduction of everything that was retracted; it may bring something else together, so look once more.
      has_collided = false;
      for (const VertexId v : is_retracted.ids())
        if (is_retracted[v]) lower(envelope, v, k_clearance_factor * envelope.height[v], HeightLimit::collision, scale);
      is_retracted.assign(is_retracted.size(), 0);
    } else {
      context.debug("layers collide in " + std::to_string(crossings.total) + " pairs of triangles");
      const double factor = sweep < options.max_retract_sweeps ? k_retract_factor : 0.0;
      Column<VertexId, double> bound = envelope.height;
      for (const auto& pair : crossings.pairs) {
        for (const std::uint32_t item : pair) {
          for (const VertexId v : base.wall.triangles[TriangleId(item)]) {
            is_retracted[v] = 1;
            bound[v] = std::min(bound[v], factor * envelope.height[v]);
            for (const VertexId other : base.topology.neighbours(v)) bound[other] = std::min(bound[other], k_ring_factor * envelope.height[other]);
          }
        }
      }
      has_collided = sweep < options.max_retract_sweeps;
      for (const VertexId v : bound.ids()) lower(envelope, v, bound[v], HeightLimit::collision, scale);
    }
    unwarp(base, options, HeightLimit::warp, envelope, context);
  }
}

}  // namespace sterna::volmesh
