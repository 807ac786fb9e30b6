// Problem: exact cuts leave edges of any length and sliver triangles along the curve. Each round measures the distance of every vertex from the curve
// (measure_strip), then splits edges that are long for their distance (split_long), collapses short ones (collapse_short), flips (flip_edges) and smooths
// (smooth). Finally, remaining slivers are processed one by one (remove_slivers). All loops run in order of length and number, and each has a fixed number of
// rounds: deterministic and bounded.
//
// Based on: M. Botsch, L. Kobbelt, "A remeshing approach to multiresolution modeling", SGP 2004, for the structure of the rounds; the tests of each step are
// those of strip_mesh.h.
#include "geom/boolean/remesh_strip.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>

#include "geom/math/measures.h"

namespace sterna {
namespace {

constexpr int k_rounds = 5;
constexpr int k_flip_sweeps = 3;
constexpr int k_sliver_sweeps = 4;
/// An edge is long beyond this multiple of the local length, and short below this fraction; the halves of a split edge are therefore not short.
constexpr double k_long = 1.5;
constexpr double k_short = 0.6;
/// Vertices nearer than this fraction of the input's edge lengths are merged: they belong to parts that should share a plane but differ by rounding.
constexpr double k_merge = 1e-3;
/// rad, 15 degrees: a collapse may leave an angle of this size, even if all angles were larger before.
constexpr double k_fair_angle = 0.26;
/// rad; minimum gain of a flip, so that equal diagonals are not flipped forever.
constexpr double k_flip_gain = 1e-3;
/// rad; triangles with a smaller angle are processed individually: 12 degrees.
constexpr double k_poor_angle = 0.21;
/// cos of 1 degree, within which the normals around a movable input vertex agree.
constexpr double k_flat = 0.99985;

using EdgeEnds = std::array<VertexId, 2>;

/// An edge with its sorting key.
struct RankedEdge {
  double key;
  EdgeEnds ends;
  friend bool operator<(const RankedEdge& a, const RankedEdge& b) { return std::tie(a.key, a.ends) < std::tie(b.key, b.ends); }
};

class StripRemesher {
 public:
  StripRemesher(StripInput input, const UnionOptions& options, const TriangleTree& reference)
      : options_(options),
        curve_(find_curve(input)),
        base_(std::move(input.length)),
        mesh_(std::move(input.points), std::move(input.triangles), {}, reference),
        reference_(reference),
        is_new_(base_.size(), 0) {
    measure_strip();
  }

  void run(UnionReport& report, const RunContext& context) {
    report.before = quality();
    for (int round = 0; round < k_rounds; ++round) {
      const std::int64_t n_before = n_split_ + n_collapsed_ + n_flipped_;
      constexpr double k_steps = 5.0;
      double step = 0.0;
      const auto next = [&] { context.progress((round + step++ / k_steps) / (k_rounds + 1)); };
      next();
      collapse_short();
      next();
      split_long();
      next();
      flip_edges();
      next();
      smooth();
      next();
      measure_strip();
      if (n_split_ + n_collapsed_ + n_flipped_ == n_before) break;
    }
    remove_slivers();
    measure_strip();
    report.after = quality();
    report.n_split = n_split_;
    report.n_collapsed = n_collapsed_;
    report.n_flipped = n_flipped_;
    report.n_moved = n_moved_;
  }

  StripOutput take() {
    StripOutput output;
    for (const TriangleId t : mesh_.triangles.ids()) {
      if (!mesh_.is_alive[t]) continue;
      output.triangles.push_back(mesh_.triangles[t]);
      output.is_in_strip.push_back(is_touched(t));
    }
    output.points = std::move(mesh_.points);
    return output;
  }

 private:
  static Column<VertexId, char> find_curve(const StripInput& input) {
    // A vertex whose triangles belong to two solids is on the curve.
    Column<VertexId, std::uint32_t> solid(input.points.size(), k_none);
    Column<VertexId, char> is_on_curve(input.points.size(), 0);
    for (const TriangleId t : input.triangles.ids())
      for (const VertexId v : input.triangles[t].v) {
        if (solid[v] == k_none) solid[v] = input.solid[t];
        if (solid[v] != input.solid[t]) is_on_curve[v] = 1;
      }
    return is_on_curve;
  }

  double length(const EdgeEnds& e) const { return distance(mesh_.points[e[0]], mesh_.points[e[1]]); }
  bool may_change(VertexId v) const { return is_new_[v] || is_in_strip_[v]; }
  bool is_touched(TriangleId t) const {
    const auto& v = mesh_.triangles[t].v;
    return may_change(v[0]) || may_change(v[1]) || may_change(v[2]);
  }
  double tolerance(VertexId a, VertexId b) const { return options_.deviation * std::min(local_[a].longest, local_[b].longest); }

  /// Computes the distance of each vertex from the curve, along edges, up to the strip's width. Grades the edge lengths by this distance, from those at the
  /// curve to those of the input.
  void measure_strip() {
    const std::size_t n = mesh_.points.size();
    local_ = base_;
    is_in_strip_.assign(n, 0);
    Column<VertexId, double> way(n, std::numeric_limits<double>::infinity());
    Column<VertexId, VertexId> source(n);
    using Entry = std::pair<double, VertexId>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const VertexId v : mesh_.points.ids()) {
      if (!curve_[v] || mesh_.star[v].empty()) continue;
      way[v] = 0.0;
      source[v] = v;
      queue.push({0.0, v});
    }
    while (!queue.empty()) {
      const auto [d, v] = queue.top();
      queue.pop();
      if (d > way[v]) continue;
      const LocalLength& at_curve = base_[source[v]];
      local_[v].shortest = std::min(base_[v].shortest, at_curve.shortest + (options_.strip_growth - 1.0) * d);
      local_[v].longest = std::min(base_[v].longest, at_curve.longest + (options_.strip_growth - 1.0) * d);
      if (d > options_.strip_width * at_curve.longest) continue;
      is_in_strip_[v] = 1;
      for (const VertexId w : mesh_.neighbours(v)) {
        const double further = d + length({v, w});
        if (!(further < way[w])) continue;
        way[w] = further;
        source[w] = source[v];
        queue.push({further, w});
      }
    }
  }

  /// Returns the accepted edges with at least one end that may change, each once, by length.
  template <class Accept>
  std::vector<RankedEdge> edges_where(const Accept& accept) const {
    std::vector<RankedEdge> found;
    for (const TriangleId t : mesh_.triangles.ids()) {
      if (!mesh_.is_alive[t] || !is_touched(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const EdgeEnds e{mesh_.triangles[t].v[k], mesh_.triangles[t].v[(k + 1) % 3]};
        if (e[0] < e[1] && (may_change(e[0]) || may_change(e[1])) && accept(e)) found.push_back({length(e), e});
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  bool is_long(const EdgeEnds& e) const { return length(e) > k_long * 0.5 * (local_[e[0]].longest + local_[e[1]].longest); }
  bool is_short(const EdgeEnds& e) const { return length(e) < k_short * 0.5 * (local_[e[0]].shortest + local_[e[1]].shortest); }

  void split_long() {
    std::vector<RankedEdge> edges = edges_where([&](const EdgeEnds& e) { return is_long(e); });
    std::reverse(edges.begin(), edges.end());
    for (const RankedEdge& edge : edges) {
      const auto [a, b] = edge.ends;
      const bool is_on_curve = curve_[a] && curve_[b] && mesh_.is_kept_edge(a, b);
      if (!mesh_.split(a, b).is_valid()) continue;
      const auto mean = [](const LocalLength& x, const LocalLength& y) { return LocalLength{0.5 * (x.shortest + y.shortest), 0.5 * (x.longest + y.longest)}; };
      base_.push_back(mean(base_[a], base_[b]));
      local_.push_back(mean(local_[a], local_[b]));
      curve_.push_back(is_on_curve);
      is_new_.push_back(1);
      is_in_strip_.push_back(0);
      ++n_split_;
    }
  }

  bool collapse(VertexId from, VertexId to, double least_angle) {
    if (!may_change(from)) return false;
    const CollapseLimits limits{.least_angle = least_angle,
                                .longest = std::max(k_long * std::max(local_[from].longest, local_[to].longest), longest_around(from)),
                                .tolerance = tolerance(from, to),
                                .merge = k_merge * std::min(local_[from].shortest, local_[to].shortest)};
    if (!mesh_.collapse(from, to, limits)) return false;
    ++n_collapsed_;
    return true;
  }

  double longest_around(VertexId v) const {
    double longest = 0.0;
    for (const VertexId w : mesh_.neighbours(v)) longest = std::max(longest, length({v, w}));
    return longest;
  }

  void collapse_short() {
    for (const RankedEdge& edge : edges_where([&](const EdgeEnds& e) { return is_short(e); })) {
      auto [a, b] = edge.ends;
      if (!mesh_.triangle_at(a, b).is_valid()) continue;
      if (collapse(a, b, k_fair_angle)) continue;
      collapse(b, a, k_fair_angle);
    }
  }

  void flip_edges() {
    for (int sweep = 0; sweep < k_flip_sweeps; ++sweep) {
      std::int64_t n = 0;
      for (const RankedEdge& edge : edges_where([&](const EdgeEnds& e) { return !mesh_.is_kept_edge(e[0], e[1]); })) n += flip(edge.ends);
      n_flipped_ += n;
      if (n == 0) return;
    }
  }

  bool flip(const EdgeEnds& e) { return !mesh_.is_kept_edge(e[0], e[1]) && mesh_.flip(e[0], e[1], k_flip_gain, tolerance(e[0], e[1])); }

  /// Returns true if the vertex may move. An input vertex may move only in a plane, because elsewhere it defines the shape.
  bool is_free(VertexId v) const {
    if (mesh_.star[v].empty() || !may_change(v) || curve_[v]) return false;
    const StripTriangle& first = mesh_.triangles[mesh_.star[v].front()];
    for (const TriangleId t : mesh_.star[v]) {
      const StripTriangle& other = mesh_.triangles[t];
      if (other.region != first.region || (!is_new_[v] && dot(other.normal, first.normal) < k_flat)) return false;
    }
    return mesh_.kept_neighbours(v).empty();
  }

  void smooth() {
    for (const VertexId v : mesh_.points.ids()) {
      if (!is_free(v)) continue;
      Vec3 sum;
      const std::vector<VertexId> around = mesh_.neighbours(v);
      for (const VertexId w : around) sum += mesh_.points[w];
      const Vec3 middle = sum / static_cast<double>(around.size());
      const NearestHit hit = reference_.nearest(middle, local_[v].longest);
      if (hit.triangle.is_valid() && mesh_.move(v, hit.point, tolerance(v, v))) ++n_moved_;
    }
  }

  bool improve(TriangleId t) {
    const auto v = mesh_.triangles[t].v;
    std::array<RankedEdge, 3> edges;
    for (std::size_t k = 0; k < 3; ++k) edges[k] = {length({v[k], v[(k + 1) % 3]}), {v[k], v[(k + 1) % 3]}};
    std::sort(edges.begin(), edges.end());
    if (flip(edges[2].ends) || flip(edges[1].ends)) {
      ++n_flipped_;
      return true;
    }
    // Accepts any result that is better than this triangle, because the worst angle of its neighbourhood then improves.
    const double least = mesh_.min_angle(t) + k_flip_gain;
    for (const RankedEdge& edge : edges)
      if (collapse(edge.ends[0], edge.ends[1], least) || collapse(edge.ends[1], edge.ends[0], least)) return true;
    return false;
  }

  void remove_slivers() {
    for (int sweep = 0; sweep < k_sliver_sweeps; ++sweep) {
      std::vector<std::pair<double, TriangleId>> poor;
      for (const TriangleId t : mesh_.triangles.ids())
        if (mesh_.is_alive[t] && is_touched(t) && mesh_.min_angle(t) < k_poor_angle) poor.push_back({mesh_.min_angle(t), t});
      std::sort(poor.begin(), poor.end());
      bool has_changed = false;
      for (const auto& [angle, t] : poor)
        if (mesh_.is_alive[t]) has_changed |= improve(t);
      if (!has_changed) return;
      smooth();
    }
  }

  StripQuality quality() const {
    StripQuality q{.min_angle = std::numeric_limits<double>::infinity(), .shortest_edge = std::numeric_limits<double>::infinity()};
    for (const TriangleId t : mesh_.triangles.ids()) {
      if (!mesh_.is_alive[t] || !is_touched(t)) continue;
      ++q.n_triangles;
      const double angle = mesh_.min_angle(t);
      q.min_angle = std::min(q.min_angle, angle);
      q.n_slivers += angle < k_sliver_angle;
      const auto& v = mesh_.triangles[t].v;
      for (std::size_t k = 0; k < 3; ++k) q.shortest_edge = std::min(q.shortest_edge, length({v[k], v[(k + 1) % 3]}));
    }
    if (q.n_triangles == 0) q.min_angle = q.shortest_edge = 0.0;
    return q;
  }

  const UnionOptions& options_;
  Column<VertexId, char> curve_;        ///< per vertex: on an intersection curve
  Column<VertexId, LocalLength> base_;  ///< per vertex: lengths of the input
  StripMesh mesh_;
  const TriangleTree& reference_;
  Column<VertexId, char> is_new_;
  Column<VertexId, LocalLength> local_;  ///< per vertex: lengths of the input, limited by the growth from the curve
  Column<VertexId, char> is_in_strip_;
  std::int64_t n_split_ = 0, n_collapsed_ = 0, n_flipped_ = 0, n_moved_ = 0;
};

TriMesh tri_mesh_of(const Column<VertexId, Vec3>& points, const Column<TriangleId, StripTriangle>& triangles) {
  TriMesh mesh;
  mesh.points = points;
  for (const StripTriangle& t : triangles) mesh.triangles.push_back(t.v);
  return mesh;
}

}  // namespace

StripOutput remesh_strip(StripInput input, const UnionOptions& options, UnionReport& report, const RunContext& context) {
  const TriangleTree reference(tri_mesh_of(input.points, input.triangles), context);
  StripRemesher remesher(std::move(input), options, reference);
  remesher.run(report, context);
  return remesher.take();
}

}  // namespace sterna
