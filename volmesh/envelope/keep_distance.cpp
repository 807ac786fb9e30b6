// Steps: find near locations around every top vertex; share the missing distance between both sides; make the envelope valid and clear again. A few sweeps are
// made.
#include "volmesh/envelope/keep_distance.h"

#include <algorithm>
#include <optional>

#include "geom/base/parallel.h"
#include "geom/base/sort_unique.h"
#include "geom/math/nearest.h"
#include "geom/mesh/layer_room.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

constexpr int k_sweeps = 4;
/// Cosine between growth direction (or facet normal) and the direction to the other side, which must be within 60 degrees.
constexpr double k_facing_cosine = 0.5;
constexpr double k_least_share = 0.6;   ///< fraction of a height that remains at least after one sweep
constexpr double k_good_enough = 0.98;  ///< fraction of the distance that is sufficient, so that no sweep is made because of rounding
constexpr double k_outer_share = 0.5;   ///< fraction of the distance that is kept from the outer boundary
constexpr std::size_t k_distance_chunk = 256;

/// A vertex, and the height in metres at which the top keeps its distance.
using TopHeight = std::pair<VertexId, double>;

class NearLocations {
 public:
  NearLocations(const LayerBase& base, const Collider& collider, const Envelope& envelope, const RunContext& context)
      : base_(base), collider_(collider), envelope_(envelope), edge_(base.wall.n_vertices()) {
    parallel_for(context, edge_.size(), [&](std::size_t i) { edge_[VertexId(i)] = envelope_edge(base, envelope, VertexId(i)); });
  }

  /// Appends the target heights for v's top point and for the opposing parts of the layer. `buffer` is scratch memory.
  void find(VertexId v, std::vector<std::uint32_t>& buffer, std::vector<TopHeight>& target) const {
    if (envelope_.is_collapsed(v)) return;
    const double kept = k_kept_edges * edge_[v];
    Box box;
    const Point p = envelope_.point(base_.wall, v);
    box.add(p - Vec3{kept, kept, kept});
    box.add(p + Vec3{kept, kept, kept});
    buffer.clear();
    collider_.find_cells(box, buffer);
    for (const std::uint32_t item : buffer) against_top(v, p, kept, TriangleId(item), target);
    buffer.clear();
    if (collider_.outer()) collider_.find_outer(box, buffer);
    for (const std::uint32_t item : buffer)
      if (!collider_.holds(item, v)) against_fixed(v, p, k_outer_share * kept, corners(*collider_.outer(), TriangleId(item)), target);
  }

 private:
  /// Distance from the point to an opposing triangle that is in front of the point and faces it. Empty if there is none, or if the distance is sufficient.
  struct Near {
    double distance = 0.0, cosine = 0.0, back = 0.0;
  };
  std::optional<Near> near(VertexId v, const Point& p, double kept, const std::array<Point, 3>& t, double sense) const {
    const Vec3 way = nearest_on_triangle(p, t) - p;
    const double length = norm(way);
    if (length == 0.0 || length >= k_good_enough * kept) return {};
    const double cosine = dot(way, envelope_.direction[v]) / length, back = -sense * dot(way, normalized(cross(t[1] - t[0], t[2] - t[0]))) / length;
    if (cosine < k_facing_cosine || back < k_facing_cosine) return {};
    return Near{length, cosine, back};
  }
  void against_top(VertexId v, const Point& p, double kept, TriangleId t, std::vector<TopHeight>& target) const {
    const TriangleVertices& w = base_.wall.triangles[t];
    if (is_beside(v, w)) return;
    const double gap = norm(nearest_on_triangle(base_.wall.points[v], corners(base_.wall, t)) - base_.wall.points[v]);
    kept = std::min(kept, k_kept_share * gap);
    const std::array<Point, 3> top = {envelope_.point(base_.wall, w[0]), envelope_.point(base_.wall, w[1]), envelope_.point(base_.wall, w[2])};
    const std::optional<Near> found = near(v, p, kept, top, 1.0);
    if (!found) return;
    const bool has_height = std::ranges::any_of(w, [&](VertexId u) { return !envelope_.is_collapsed(u); });
    const double missing = (has_height ? 0.5 : 1.0) * (kept - found->distance);
    lower_by(v, missing / found->cosine, target);
    for (const VertexId u : w) lower_by(u, missing / found->back, target);
  }
  void against_fixed(VertexId v, const Point& p, double kept, const std::array<Point, 3>& t, std::vector<TopHeight>& target) const {
    // Triangles of the outer boundary may point into the fluid or out of it.
    std::optional<Near> found = near(v, p, kept, t, 1.0);
    if (!found) found = near(v, p, kept, t, -1.0);
    if (found) lower_by(v, (kept - found->distance) / found->cosine, target);
  }
  void lower_by(VertexId v, double depth, std::vector<TopHeight>& target) const {
    const double height = envelope_.height[v];
    if (height > 0.0) target.emplace_back(v, std::max(height - depth, k_least_share * height));
  }
  bool is_beside(VertexId v, const TriangleVertices& t) const {
    const auto around = base_.topology.neighbours(v);
    return std::ranges::any_of(t, [&](VertexId w) { return w == v || std::ranges::find(around, w) != around.end(); });
  }

  const LayerBase& base_;
  const Collider& collider_;
  const Envelope& envelope_;
  Column<VertexId, double> edge_;  ///< m, edges of the envelope
};

}  // namespace

void keep_distance(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  const EnvelopeScale scale = scale_of(base, options);
  for (int sweep = 0; sweep < k_sweeps; ++sweep) {
    collider.move_top(envelope, context);
    const NearLocations locations(base, collider, envelope, context);
    std::vector<TopHeight> target = parallel_collect<TopHeight>(
        context, base.wall.n_vertices(),
        [&](std::size_t begin, std::size_t end, std::vector<TopHeight>& list) {
          std::vector<std::uint32_t> buffer;
          for (std::size_t i = begin; i < end; ++i) locations.find(VertexId(i), buffer, list);
        },
        k_distance_chunk);
    if (target.empty()) return;
    std::ranges::sort(target);
    std::vector<VertexId> lowered;
    for (const auto& [v, height] : target) {
      if (!lowered.empty() && lowered.back() == v) continue;  // only the lowest height of each vertex is used, which comes first
      lowered.push_back(v);
      lower(envelope, v, height, HeightLimit::gap, scale);
      envelope.cap[v] = std::min(envelope.cap[v], height);
    }
    const std::vector<VertexId> more = unwarp(base, options, HeightLimit::warp, envelope, context, &lowered);
    lowered.insert(lowered.end(), more.begin(), more.end());
    sort_unique(lowered);
    retract_collisions(base, options, collider, envelope, context, &lowered);
  }
}

}  // namespace sterna::volmesh
