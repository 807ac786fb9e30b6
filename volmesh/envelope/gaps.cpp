// Gaps between opposing walls. For each growth line the opposing wall is searched within the reach of both layers.
#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/mesh/layer_room.h"
#include "volmesh/envelope/keep_distance.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

/// Number of edges (the longer local envelope edge) for which room remains between two layers, for tetrahedra.
constexpr double k_remaining_edges = k_kept_edges;
constexpr double k_remaining_share = k_kept_share;  ///< fraction of a gap that remains if the gap is too narrow for k_remaining_edges
constexpr double k_gap_opposing_cosine = 0.7;  ///< a wall is opposing if it faces the growth line within 45 degrees; all other walls are left to the exact test
constexpr int k_level_sweeps = 3;

/// Returns the parameter s in [0, 1] at which the segment p + s d intersects the triangle, or a negative number. Rounding does not matter, because heights keep
/// a reserve.
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

class GapFinder {
 public:
  GapFinder(const LayerBase& base, const Collider& collider, const Envelope& envelope, const Column<VertexId, std::uint32_t>* group, const RunContext& context)
      : base_(base), collider_(collider), envelope_(envelope), group_(group), edge_(base.wall.n_vertices()) {
    parallel_for(context, edge_.size(), [&](std::size_t i) { edge_[VertexId(i)] = envelope_edge(base, envelope, VertexId(i)); });
  }

  /// Appends the hit of v's growth line if the heights of both layers exceed the room in the gap. `buffer` is scratch memory.
  void find(VertexId v, std::vector<std::uint32_t>& buffer, std::vector<WallGap>& hits) const {
    if (envelope_.is_collapsed(v)) return;
    const double reach = envelope_.height[v] + k_remaining_edges * edge_[v] / k_gap_opposing_cosine;
    if (!group_ || (*group_)[v] != 0) find_outer(v, reach, buffer, hits);
    const double look = how_far_to_look(v, reach, buffer);
    if (look == 0.0) return;
    const Vec3 segment = look * envelope_.direction[v];
    buffer.clear();
    collider_.find_walls(box_along(v, look), buffer);
    double first = 2.0;
    TriangleId nearest;
    for (const std::uint32_t item : buffer) {
      const TriangleId t(item);
      if (!opposes(v, t)) continue;
      const double s = segment_hit(base_.wall.points[v], segment, corners(base_.wall, t));
      if (s < 0.0 || s > first || (s == first && nearest < t)) continue;
      first = s;
      nearest = t;
    }
    if (!nearest.is_valid() || is_shared_before(v, nearest)) return;
    // Along an inclined growth line, the section between the layers is longer than the remaining gap.
    const double edge = std::max(edge_[v], largest(edge_, nearest)) / cosine(v, nearest);
    add_hit(v, nearest, first * look, edge, height_against(v, nearest), hits);
  }

 private:
  void add_hit(VertexId v, TriangleId opposite, double gap, double edge, double opposite_height, std::vector<WallGap>& hits) const {
    const double remaining = std::min(k_remaining_edges * edge, k_remaining_share * gap);
    const double share = (gap - remaining) / (envelope_.height[v] + opposite_height);
    if (share < 1.0) hits.push_back({v, opposite, gap, share});
  }
  void find_outer(VertexId v, double reach, std::vector<std::uint32_t>& buffer, std::vector<WallGap>& hits) const {
    buffer.clear();
    collider_.find_outer(box_along(v, reach), buffer);
    const Vec3 segment = reach * envelope_.direction[v];
    double first = 2.0;
    for (const std::uint32_t item : buffer) {
      if (collider_.holds(item, v)) continue;
      const double s = segment_hit(base_.wall.points[v], segment, corners(*collider_.outer(), TriangleId(item)));
      if (s >= 0.0) first = std::min(first, s);
    }
    if (first <= 1.0) add_hit(v, {}, first * reach, edge_[v], 0.0, hits);
  }
  double largest(const Column<VertexId, double>& values, TriangleId t) const {
    const TriangleVertices& v = base_.wall.triangles[t];
    return std::max({values[v[0]], values[v[1]], values[v[2]]});
  }
  double cosine(VertexId v, TriangleId t) const { return -dot(base_.unit_normal[t], envelope_.direction[v]); }
  bool opposes(VertexId v, TriangleId t) const {
    const TriangleVertices& own = base_.wall.triangles[t];
    return cosine(v, t) >= k_gap_opposing_cosine && own[0] != v && own[1] != v && own[2] != v;
  }
  bool is_shared_before(VertexId v, TriangleId t) const { return group_ && (*group_)[v] == (*group_)[base_.wall.triangles[t][0]]; }
  /// Returns the extent along v's growth line of the layer on t.
  double height_against(VertexId v, TriangleId t) const { return largest(envelope_.height, t) / cosine(v, t); }
  Box box_along(VertexId v, double length) const {
    Box box;
    box.add(base_.wall.points[v]);
    box.add(base_.wall.points[v] + length * envelope_.direction[v]);
    return box;
  }
  /// Returns the length along the growth line over which to search; 0 if there is no opposing layer. A conflict begins where the growth line meets the opposite
  /// layer, which may be far from the wall below that layer. Therefore layers are searched first, then the walls below them.
  double how_far_to_look(VertexId v, double reach, std::vector<std::uint32_t>& buffer) const {
    buffer.clear();
    collider_.find_cells(box_along(v, reach), buffer);
    double look = 0.0;
    for (const std::uint32_t item : buffer) {
      const TriangleId t(item);
      if (!opposes(v, t) || is_shared_before(v, t)) continue;
      look = std::max(look, std::max(reach, envelope_.height[v] + k_remaining_edges * largest(edge_, t) / cosine(v, t)) + height_against(v, t));
    }
    return look;
  }

  const LayerBase& base_;
  const Collider& collider_;
  const Envelope& envelope_;
  const Column<VertexId, std::uint32_t>* group_;  ///< may be null
  Column<VertexId, double> edge_;                 ///< m, local envelope edge
};

}  // namespace

std::vector<WallGap> share_gaps(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context,
                                const Column<VertexId, std::uint32_t>* group) {
  const EnvelopeScale scale = scale_of(base, options);
  collider.move_top(envelope, context);
  const GapFinder finder(base, collider, envelope, group, context);
  std::vector<WallGap> hits = parallel_collect<WallGap>(
      context, base.wall.n_vertices(),
      [&](std::size_t begin, std::size_t end, std::vector<WallGap>& found) {
        std::vector<std::uint32_t> buffer;
        for (std::size_t i = begin; i < end; ++i) finder.find(VertexId(i), buffer, found);
      },
      256);
  if (hits.empty()) return hits;
  const Column<VertexId, double> requested = envelope.height;
  std::vector<VertexId> lowered;
  const auto limit = [&](VertexId v, double share) {
    envelope.cap[v] = std::min(envelope.cap[v], share * requested[v]);
    lower(envelope, v, share * requested[v], HeightLimit::gap, scale);
    lowered.push_back(v);
  };
  for (const WallGap& hit : hits) {
    limit(hit.vertex, hit.share);
    if (!hit.opposite.is_valid()) continue;
    for (const VertexId v : base.wall.triangles[hit.opposite]) limit(v, hit.share);
  }
  level_steps(base, options, k_level_sweeps, HeightLimit::gap, envelope, context);
  unwarp(base, options, HeightLimit::warp, envelope, context);
  return hits;
}

}  // namespace sterna::volmesh
