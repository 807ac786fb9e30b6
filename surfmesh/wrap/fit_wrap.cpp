// An alpha wrap is closed and free of self-intersection, but it lies `offset` outside of its input, cuts off sharp edges, and has poor triangles. The following
// steps correct this:
// 1. bring_back: every vertex moves to the nearest point of the input.
// 2. snap_to_lines: the vertices nearest to corners and sharp edges move onto them.
// 3. split_crossed: edges that still cross a sharp edge get a vertex on it. 4. refine: edges that are too far from the input get a vertex on the input.
// 5. improve: rounds of collapses, flips and smoothing, all within the tolerance of the input and of the closures of its openings. Each step keeps the surface
// free of self-intersection (exact test). Single changes use strip_mesh.h, simultaneous moves of all vertices use move_clear.h.
#include "surfmesh/wrap/fit_wrap.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/base/parallel.h"
#include "geom/boolean/strip_mesh.h"
#include "geom/math/measures.h"
#include "geom/math/nearest.h"
#include "surfmesh/wrap/move_clear.h"

namespace sterna::surfmesh {
namespace {

/// Relative to the local edge length: a vertex nearer than the first distance to a corner, or nearer than the second to a line, moves there.
constexpr double k_corner_reach = 0.6, k_line_reach = 0.4;
/// Relative to an edge's length: if a line is within the first distance of the edge's middle, the edge may cut off the sharp edge at this line. (A sharp edge
/// of 90 degrees is half a length away, one of 60 degrees 0.87.) If both ends of the edge are on the same side of the line, only lines within the second
/// distance are used.
constexpr double k_crossing_reach = 0.9, k_side_reach = 0.35;
/// Rad: largest turn of a triangle in a step onto a line (80 degrees), and smallest angle that the triangle must keep (2.5 degrees).
constexpr double k_line_turn = 1.4, k_line_angle = 0.044;
constexpr int k_refine_rounds = 4;
/// Lower limit of edge lengths in refinement, relative to the edge length of the wrap.
constexpr double k_least_edge = 1.0 / 6.0;
constexpr int k_improve_rounds = 3;
/// Relative to the edge length of the wrap: edges shorter than the first value are collapsed if the tolerance allows it, and no edge longer than the second
/// value may result.
constexpr double k_short_edge = 0.5, k_long_edge = 1.7;
/// Rad: triangles keep at least 17 degrees in collapses and 15 degrees in smoothing, if their angles were that large before. Triangles below k_poor (20
/// degrees) get a separate step.
constexpr double k_collapse_angle = 0.3, k_smooth_angle = 0.26, k_poor = 0.35;
/// Rad, 6 degrees: below this angle, the removal of a sliver triangle takes precedence over the quality of adjacent triangles.
constexpr double k_sliver = 0.105;
constexpr double k_gain = 1e-3;
/// Relative to the edge length of the wrap: a vertex nearer than this to a vertex on a line is merged into it.
constexpr double k_merged_edge = 0.25;
/// Rad: in smoothing no triangle turns by more than 29 degrees.
constexpr double k_smooth_turn = 0.5;

using Facets = std::vector<std::array<std::uint32_t, 3>>;
using Ends = std::array<std::uint32_t, 2>;
using StripEnds = std::array<VertexId, 2>;  ///< vertices of a StripMesh

TriMesh segments_mesh(const std::vector<std::array<Vec3, 2>>& lines) {
  TriMesh mesh;
  for (const auto& [a, b] : lines) {
    const VertexId v = mesh.points.push_back(a), w = mesh.points.push_back(b);
    mesh.triangles.push_back({v, w, w});
  }
  return mesh;
}

TriMesh points_mesh(const std::vector<Vec3>& points) {
  TriMesh mesh;
  for (const Vec3& p : points) {
    const VertexId v = mesh.points.push_back(p);
    mesh.triangles.push_back({v, v, v});
  }
  return mesh;
}

std::vector<double> mean_edges(const std::vector<Vec3>& points, const Facets& triangles) {
  std::vector<double> sum(points.size(), 0.0);
  std::vector<int> n(points.size(), 0);
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = distance(points[t[k]], points[t[(k + 1) % 3]]);
      sum[t[k]] += length;
      sum[t[(k + 1) % 3]] += length;
      ++n[t[k]];
      ++n[t[(k + 1) % 3]];
    }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = n[v] > 0 ? sum[v] / n[v] : 0.0;
  return sum;
}

/// Returns each edge once, from its lower to its higher vertex, sorted.
std::vector<Ends> edges_of(const Facets& triangles, const RunContext& context) {
  std::vector<Ends> edges;
  edges.reserve(triangles.size() * 3 / 2);
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k] < t[(k + 1) % 3]) edges.push_back({t[k], t[(k + 1) % 3]});
  parallel_sort(context, edges, std::less<>());
  return edges;
}

class WrapFitter {
 public:
  WrapFitter(const WrapSurface& wrap, const InputSurface& surface, const WrapSizes& sizes, double feature_angle, const RunContext& context)
      : surface_(surface), sizes_(sizes), feature_angle_(feature_angle), context_(context) {
    now_.points = wrap.points;
    now_.triangles = wrap.triangles;
    now_.patch.assign(wrap.triangles.size(), 0);
    now_.tie.assign(wrap.points.size(), LineTie::none);
  }

  FittedWrap run() {
    bring_back(surface_.facets(), context_);
    context_.progress(0.15);
    snap_to_lines();
    context_.progress(0.25);
    split_crossed();
    context_.progress(0.3);
    refine();
    context_.progress(0.4);
    now_.patch = patches_of(now_.points, now_.triangles, surface_, sizes_, context_);
    const TriangleTree near(with_closures(), context_);
    for (int round = 0; round < k_improve_rounds; ++round) {
      improve(near);
      context_.progress(0.4 + 0.55 * (round + 1.0) / k_improve_rounds);
    }
    bring_back(near, context_);
    finish(near);
    return std::move(now_);
  }

 private:
  void bring_back(const TriangleTree& near, const RunContext& context) {
    std::vector<Vec3> targets = now_.points;
    parallel_for(
        context, targets.size(),
        [&](std::size_t v) {
          const NearestHit hit = now_.tie[v] == LineTie::none ? near.nearest(targets[v]) : surface_.nearest_line(targets[v], sizes_.edge);
          if (hit.triangle.is_valid() && now_.tie[v] != LineTie::corner && hit.distance > 1e-9 * sizes_.edge) targets[v] = hit.point;
        },
        512);
    now_.points = move_clear(std::move(now_.points), now_.triangles, targets, {}, context).points;
  }

  void snap_to_lines() {
    const std::vector<double> length = mean_edges(now_.points, now_.triangles);
    const std::size_t n = now_.points.size();
    std::vector<Vec3> targets = now_.points;
    std::vector<LineTie> tie(n, LineTie::none);
    std::vector<NearestHit> corner(n);
    parallel_for(
        context_, n,
        [&](std::size_t v) {
          corner[v] = surface_.nearest_corner(now_.points[v], k_corner_reach * length[v]);
          const NearestHit line = surface_.nearest_line(now_.points[v], k_line_reach * length[v]);
          if (!line.triangle.is_valid()) return;
          targets[v] = line.point;
          tie[v] = LineTie::line;
        },
        512);
    // Only the vertex nearest to a corner moves there.
    std::map<std::uint32_t, std::uint32_t> best;
    for (std::uint32_t v = 0; v < n; ++v) {
      if (!corner[v].triangle.is_valid()) continue;
      const auto [known, is_new] = best.try_emplace(corner[v].triangle.value(), v);
      if (!is_new && corner[v].distance < corner[known->second].distance) known->second = v;
    }
    for (const auto& [c, v] : best) {
      targets[v] = corner[v].point;
      tie[v] = LineTie::corner;
    }
    ClearMove moved = move_clear(now_.points, now_.triangles, targets, {.max_turn = k_line_turn, .least_angle = k_line_angle, .is_whole = true}, context_);
    for (std::size_t v = 0; v < n; ++v) now_.tie[v] = moved.has_arrived[v] ? tie[v] : LineTie::none;
    now_.points = std::move(moved.points);
  }

  StripMesh strip_mesh(const TriangleTree& near) const {
    Column<TriangleId, StripTriangle> triangles;
    triangles.reserve(now_.triangles.size());
    for (std::size_t t = 0; t < now_.triangles.size(); ++t) {
      const auto& v = now_.triangles[t];
      triangles.push_back(
          {{VertexId(v[0]), VertexId(v[1]), VertexId(v[2])}, now_.patch[t], normalized(area_vector(now_.points[v[0]], now_.points[v[1]], now_.points[v[2]]))});
    }
    return StripMesh(Column<VertexId, Vec3>(now_.points), std::move(triangles), {.max_bend = feature_angle_}, near);
  }

  /// Takes over the remaining mesh. Returns the new number of each of its vertices.
  Column<VertexId, std::uint32_t> take(const StripMesh& mesh) {
    FittedWrap next;
    Column<VertexId, std::uint32_t> number(mesh.points.size(), k_none);
    now_.tie.resize(mesh.points.size(), LineTie::none);
    for (const TriangleId t : mesh.triangles.ids()) {
      if (!mesh.is_alive[t]) continue;
      std::array<std::uint32_t, 3> v{};
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId old = mesh.triangles[t].v[k];
        std::uint32_t& mine = number[old];
        if (mine == k_none) {
          mine = static_cast<std::uint32_t>(next.points.size());
          next.points.push_back(mesh.points[old]);
          next.tie.push_back(now_.tie[old.index()]);
        }
        v[k] = mine;
      }
      next.triangles.push_back(v);
      next.patch.push_back(mesh.triangles[t].region);
    }
    now_ = std::move(next);
    return number;
  }

  /// Result of a planned split. Splits are computed in parallel and executed in order.
  struct NewPoint {
    bool is_needed = false;
    bool is_on_line = false;
    Vec3 at;
  };
  template <class Choose>
  std::size_t split_where(const Choose& choose) {
    const std::vector<Ends> edges = edges_of(now_.triangles, context_);
    std::vector<NewPoint> points(edges.size());
    parallel_for(
        context_, edges.size(), [&](std::size_t e) { points[e] = choose(edges[e]); }, 512);
    std::vector<std::pair<double, std::size_t>> order;  // edges, longest first
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (points[e].is_needed) order.push_back({-distance(now_.points[edges[e][0]], now_.points[edges[e][1]]), e});
    if (order.empty()) return 0;
    std::sort(order.begin(), order.end());
    // All edges are first split in the middle. Then all new vertices move at once, so that no triangle has to turn while only some of its vertices are in
    // place.
    StripMesh mesh = strip_mesh(surface_.facets());
    std::vector<std::pair<VertexId, std::size_t>> made;
    for (const auto& [key, e] : order)
      if (const VertexId m = mesh.split(VertexId(edges[e][0]), VertexId(edges[e][1])); m.is_valid()) made.push_back({m, e});
    const Column<VertexId, std::uint32_t> number = take(mesh);
    std::vector<Vec3> targets = now_.points;
    for (const auto& [m, e] : made) targets[number[m]] = points[e].at;
    ClearMove moved = move_clear(now_.points, now_.triangles, targets, {.max_turn = k_line_turn, .least_angle = k_line_angle}, context_);
    for (const auto& [m, e] : made)
      if (points[e].is_on_line && moved.has_arrived[number[m]]) now_.tie[number[m]] = LineTie::line;
    now_.points = std::move(moved.points);
    return made.size();
  }

  /// Returns the point of a line that the edge crosses, or at which the edge cuts off the sharp edge.
  NearestHit crossed_line(const Vec3& a, const Vec3& b) const {
    const double length = distance(a, b);
    const Vec3 middle = 0.5 * (a + b);
    const NearestHit line = surface_.nearest_line(middle, k_crossing_reach * length);
    if (!line.triangle.is_valid()) return line;
    const double along = dot(line.point - a, b - a) / (length * length);
    if (along < 0.2 || along > 0.8) return {};
    if (line.distance < k_side_reach * length && line.distance > 0.0) {
      const NearestHit hit = surface_.nearest(middle);
      if (hit.distance > sizes_.tolerance) return line;
    }
    const NearestHit at_a = surface_.nearest(a, sizes_.edge), at_b = surface_.nearest(b, sizes_.edge);
    if (!at_a.triangle.is_valid() || !at_b.triangle.is_valid()) return {};
    const auto patch = [&](const NearestHit& hit) { return surface_.input().mesh.triangle_patch[hit.triangle]; };
    const double bend = std::acos(std::clamp(std::abs(dot(surface_.normal(at_a.triangle), surface_.normal(at_b.triangle))), 0.0, 1.0));
    return bend >= 0.5 * feature_angle_ || patch(at_a) != patch(at_b) ? line : NearestHit{};
  }

  void split_crossed() {
    if (surface_.input().lines.empty()) return;
    split_where([&](const Ends& e) {
      if (now_.tie[e[0]] != LineTie::none || now_.tie[e[1]] != LineTie::none) return NewPoint{};
      const NearestHit line = crossed_line(now_.points[e[0]], now_.points[e[1]]);
      return line.triangle.is_valid() ? NewPoint{true, true, line.point} : NewPoint{};
    });
    bring_far_back();
  }

  void refine() {
    for (int round = 0; round < k_refine_rounds; ++round) {
      const std::size_t n = split_where([&](const Ends& e) {
        NewPoint made;
        const Vec3 &a = now_.points[e[0]], &b = now_.points[e[1]];
        const double length = distance(a, b);
        if (length < 2.0 * k_least_edge * sizes_.edge) return made;
        const Vec3 middle = 0.5 * (a + b);
        const NearestHit hit = surface_.nearest(middle, sizes_.edge);
        if (!hit.triangle.is_valid() || hit.distance <= sizes_.tolerance || surface_.is_on_border(hit)) return made;
        const NearestHit line = crossed_line(a, b);
        if (line.triangle.is_valid()) return NewPoint{true, true, line.point};
        return NewPoint{true, false, hit.point};
      });
      if (n == 0) return;
      bring_far_back();
    }
  }

  /// Moves vertices that a split left between the wrap and the input. They move onto a line if one is near.
  void bring_far_back() {
    const std::vector<double> length = mean_edges(now_.points, now_.triangles);
    std::vector<Vec3> targets = now_.points;
    std::vector<char> is_to_line(targets.size(), 0);
    parallel_for(
        context_, targets.size(),
        [&](std::size_t v) {
          if (now_.tie[v] != LineTie::none) return;
          const NearestHit hit = surface_.nearest(now_.points[v], sizes_.edge);
          if (!hit.triangle.is_valid() || hit.distance <= 0.5 * sizes_.tolerance || surface_.is_on_border(hit)) return;
          const NearestHit line = surface_.nearest_line(now_.points[v], k_corner_reach * length[v]);
          is_to_line[v] = line.triangle.is_valid();
          targets[v] = is_to_line[v] ? line.point : hit.point;
        },
        512);
    ClearMove moved = move_clear(now_.points, now_.triangles, targets, {.max_turn = k_line_turn, .least_angle = k_line_angle}, context_);
    for (std::size_t v = 0; v < targets.size(); ++v)
      if (is_to_line[v] && moved.has_arrived[v]) now_.tie[v] = LineTie::line;
    now_.points = std::move(moved.points);
  }

  /// Returns the input together with the triangles of the wrap beyond the tolerance, which close openings and grooves.
  TriMesh with_closures() const {
    TriMesh all = surface_.input().mesh;
    all.triangle_patch.clear();
    all.patches.clear();
    std::vector<char> is_far(now_.triangles.size(), 0);
    parallel_for(
        context_, now_.triangles.size(),
        [&](std::size_t t) {
          const auto& v = now_.triangles[t];
          const Vec3 &a = now_.points[v[0]], &b = now_.points[v[1]], &c = now_.points[v[2]];
          for (const Vec3& p : {(a + b + c) / 3.0, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)})
            if (!surface_.nearest(p, sizes_.tolerance).triangle.is_valid()) is_far[t] = 1;
        },
        512);
    const std::size_t n = all.n_vertices();
    for (const Vec3& p : now_.points) all.points.push_back(p);
    for (std::size_t t = 0; t < is_far.size(); ++t) {
      if (!is_far[t]) continue;
      const auto& v = now_.triangles[t];
      all.triangles.push_back({VertexId(n + v[0]), VertexId(n + v[1]), VertexId(n + v[2])});
    }
    return all;
  }

  // ---- Better triangles ----

  LineTie tie(VertexId v) const { return now_.tie[v.index()]; }

  bool may_go(VertexId from, VertexId to) const { return tie(from) == LineTie::none || (tie(from) == LineTie::line && tie(to) != LineTie::none); }

  bool try_collapse(StripMesh& mesh, VertexId from, VertexId to, double least_angle) const {
    if (!may_go(from, to)) return false;
    return mesh.collapse(from, to, {.least_angle = least_angle, .longest = k_long_edge * sizes_.edge, .tolerance = sizes_.tolerance, .merge = 0.0});
  }

  /// Collapses an edge along a line. Adjacent triangles do not restrict this merge, as long as nothing leaves the input, inverts or crosses.
  bool try_along_line(StripMesh& mesh, VertexId from, VertexId to) const {
    if (tie(from) != LineTie::line || tie(to) == LineTie::none) return false;
    const Vec3 &a = mesh.points[from], &b = mesh.points[to];
    if (!surface_.nearest_line(0.5 * (a + b), 0.05 * distance(a, b)).triangle.is_valid()) return false;
    return mesh.collapse(
        from, to,
        {.least_angle = 0.0, .longest = k_long_edge * sizes_.edge, .tolerance = sizes_.tolerance, .merge = 0.05 * sizes_.edge, .is_one_location = true});
  }

  bool try_flip(StripMesh& mesh, VertexId a, VertexId b) const { return !mesh.is_kept_edge(a, b) && mesh.flip(a, b, k_gain, sizes_.tolerance); }

  void collapse_short(StripMesh& mesh) const {
    std::vector<std::pair<double, Ends>> order;
    for (const Ends& e : edges_of(now_.triangles, context_)) {
      const double length = distance(now_.points[e[0]], now_.points[e[1]]);
      if (length < k_short_edge * sizes_.edge) order.push_back({length, e});
    }
    std::sort(order.begin(), order.end());
    std::size_t n = 0;
    for (const auto& [length, e] : order) {
      if (++n % 1024 == 0) context_.check_stop();
      VertexId from(e[0]), to(e[1]);
      if (!mesh.triangle_at(from, to).is_valid()) continue;
      // The end that is less tied to a line or corner is removed.
      if (tie(to) < tie(from)) std::swap(from, to);
      if (!try_collapse(mesh, from, to, k_collapse_angle)) try_collapse(mesh, to, from, k_collapse_angle);
    }
  }

  /// Merges vertices onto lines. The wrap rounds a sharp edge with two rows of vertices, one of which is on the line. The vertices of the other row are merged
  /// into it, whatever the angles of the strip between them.
  void merge_onto_lines(StripMesh& mesh) const {
    std::vector<std::pair<double, Ends>> order;
    for (const Ends& e : edges_of(now_.triangles, context_)) {
      const Vec3 &a = now_.points[e[0]], &b = now_.points[e[1]];
      const double length = distance(a, b);
      const LineTie freer = std::min(now_.tie[e[0]], now_.tie[e[1]]), other = std::max(now_.tie[e[0]], now_.tie[e[1]]);
      if (length >= k_merged_edge * sizes_.edge || other == LineTie::none || freer == LineTie::corner) continue;
      // Both vertices must be on one line, not on two lines near each other. Therefore the edge between them must lie on the line.
      if (freer == LineTie::line && !surface_.nearest_line(0.5 * (a + b), 0.05 * length).triangle.is_valid()) continue;
      order.push_back({length, now_.tie[e[0]] == freer ? e : Ends{e[1], e[0]}});
    }
    std::sort(order.begin(), order.end());
    for (const auto& [length, e] : order)
      if (const VertexId from(e[0]), to(e[1]); mesh.triangle_at(from, to).is_valid())
        mesh.collapse(from, to,
                      {.least_angle = 0.0, .longest = k_long_edge * sizes_.edge, .tolerance = sizes_.tolerance, .merge = k_merged_edge * sizes_.edge});
  }

  /// Flips edges if that increases the smallest angle of the two triangles.
  void flip_all(StripMesh& mesh) const {
    std::vector<std::pair<double, TriangleId>> order;
    for (const TriangleId t : mesh.triangles.ids())
      if (mesh.is_alive[t]) order.push_back({mesh.min_angle(t), t});
    std::sort(order.begin(), order.end());
    std::size_t n = 0;
    for (const auto& [angle, t] : order) {
      if (++n % 1024 == 0) context_.check_stop();
      if (!mesh.is_alive[t]) continue;
      const auto v = mesh.triangles[t].v;
      std::array<std::pair<double, StripEnds>, 3> edges;
      for (std::size_t k = 0; k < 3; ++k) edges[k] = {-distance(mesh.points[v[k]], mesh.points[v[(k + 1) % 3]]), {v[k], v[(k + 1) % 3]}};
      std::sort(edges.begin(), edges.end());
      for (std::size_t k = 0; k < 2; ++k)
        if (would_gain(mesh, edges[k].second) && try_flip(mesh, edges[k].second[0], edges[k].second[1])) break;
    }
  }

  static bool would_gain(const StripMesh& mesh, const StripEnds& e) {
    const TriangleId left = mesh.triangle_at(e[0], e[1]), right = mesh.triangle_at(e[1], e[0]);
    if (!left.is_valid() || !right.is_valid()) return false;
    const VertexId c = mesh.opposite(left, e[0], e[1]), d = mesh.opposite(right, e[0], e[1]);
    return std::min(mesh.min_angle({e[0], d, c}), mesh.min_angle({d, e[1], c})) > std::min(mesh.min_angle(left), mesh.min_angle(right)) + k_gain;
  }

  /// Flips the longest edge of a nearly flat triangle. Such a triangle has no normal of its own, so the normal of its neighbour is used.
  bool try_flip_sliver(StripMesh& mesh, TriangleId t, VertexId a, VertexId b) const {
    const TriangleId left = mesh.triangle_at(a, b), right = mesh.triangle_at(b, a);
    if (!left.is_valid() || !right.is_valid()) return false;
    const TriangleId other = left == t ? right : left;
    const Vec3 own = mesh.triangles[t].normal;
    const std::uint32_t region = mesh.triangles[t].region;
    mesh.triangles[t].normal = mesh.triangles[other].normal;
    mesh.triangles[t].region = mesh.triangles[other].region;
    if (mesh.flip(a, b, k_gain, sizes_.tolerance)) return true;
    mesh.triangles[t].normal = own;
    mesh.triangles[t].region = region;
    return false;
  }

  void remove_poor(StripMesh& mesh) const {
    for (int sweep = 0; sweep < 2; ++sweep) {
      std::vector<std::pair<double, TriangleId>> poor;
      for (const TriangleId t : mesh.triangles.ids())
        if (mesh.is_alive[t] && mesh.min_angle(t) < k_poor) poor.push_back({mesh.min_angle(t), t});
      std::sort(poor.begin(), poor.end());
      bool has_changed = false;
      for (const auto& [angle, t] : poor) {
        if (!mesh.is_alive[t]) continue;
        const auto v = mesh.triangles[t].v;
        std::array<std::pair<double, StripEnds>, 3> edges;
        for (std::size_t k = 0; k < 3; ++k) edges[k] = {distance(mesh.points[v[k]], mesh.points[v[(k + 1) % 3]]), {v[k], v[(k + 1) % 3]}};
        std::sort(edges.begin(), edges.end());
        bool is_done = try_flip(mesh, edges[2].second[0], edges[2].second[1]) || try_flip(mesh, edges[1].second[0], edges[1].second[1]);
        if (!is_done && angle < k_sliver) is_done = try_flip_sliver(mesh, t, edges[2].second[0], edges[2].second[1]);
        for (std::size_t k = 0; k < 3 && !is_done; ++k) {
          const auto [a, b] = edges[k].second;
          is_done = try_collapse(mesh, a, b, angle + k_gain) || try_collapse(mesh, b, a, angle + k_gain);
          if (angle < k_sliver) is_done = is_done || try_along_line(mesh, a, b) || try_along_line(mesh, b, a);
        }
        has_changed |= is_done;
      }
      if (!has_changed) return;
      context_.check_stop();
    }
  }

  /// Moves vertices to the centre of their neighbours. Vertices on kept edges move to the middle of the two neighbours along these edges.
  void smooth(const TriangleTree& near) {
    const std::size_t n = now_.points.size();
    const Facets& triangles = now_.triangles;
    // A neighbour with the two triangles at the edge to it, which show if the edge is kept.
    struct Side {
      std::uint32_t from, to, triangle;
    };
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    std::vector<Vec3> normal(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const auto& v = triangles[t];
      normal[t] = normalized(area_vector(now_.points[v[0]], now_.points[v[1]], now_.points[v[2]]));
      for (std::size_t k = 0; k < 3; ++k) sides.push_back({v[k], v[(k + 1) % 3], t});
    }
    std::vector<std::vector<Side>> around(n), towards(n);
    for (const Side& s : sides) {
      around[s.from].push_back(s);
      towards[s.to].push_back(s);
    }
    const double least = std::cos(feature_angle_);
    std::vector<Vec3> targets = now_.points;
    parallel_for(
        context_, n,
        [&](std::size_t v) {
          if (now_.tie[v] == LineTie::corner) return;
          Vec3 sum;
          std::vector<std::uint32_t> kept;
          for (const Side& out : around[v]) {
            sum += now_.points[out.to];
            for (const Side& in : towards[v])
              if (in.from == out.to && (dot(normal[in.triangle], normal[out.triangle]) < least || now_.patch[in.triangle] != now_.patch[out.triangle]))
                kept.push_back(out.to);
          }
          if (kept.empty() && now_.tie[v] == LineTie::none) {
            const NearestHit hit = near.nearest(sum / static_cast<double>(around[v].size()), sizes_.edge);
            if (hit.triangle.is_valid()) targets[v] = hit.point;
          } else if (kept.size() == 2 && now_.tie[v] == LineTie::line) {
            const NearestHit hit = surface_.nearest_line(0.5 * (now_.points[kept[0]] + now_.points[kept[1]]), sizes_.edge);
            if (hit.triangle.is_valid()) targets[v] = hit.point;
          }
        },
        512);
    now_.points = move_clear(std::move(now_.points), triangles, targets, {.max_turn = k_smooth_turn, .least_angle = k_smooth_angle}, context_).points;
  }

  void improve(const TriangleTree& near) {
    {
      StripMesh mesh = strip_mesh(near);
      merge_onto_lines(mesh);
      collapse_short(mesh);
      flip_all(mesh);
      remove_poor(mesh);
      take(mesh);
    }
    smooth(near);
  }

  /// Improves the final mesh without moving vertices, because they already lie on the input.
  void finish(const TriangleTree& near) {
    StripMesh mesh = strip_mesh(near);
    merge_onto_lines(mesh);
    flip_all(mesh);
    remove_poor(mesh);
    take(mesh);
  }

  const InputSurface& surface_;
  const WrapSizes& sizes_;
  double feature_angle_;
  const RunContext& context_;
  FittedWrap now_;
};

}  // namespace

// ---- The input ----

InputSurface::InputSurface(Borrowed<const WrapInput> input, const RunContext& context)
    : input_(input), facets_(input->mesh, context), lines_(segments_mesh(input->lines), context), corners_(points_mesh(input->corners), context) {}

NearestHit InputSurface::nearest_line(const Vec3& p, double limit) const { return input_.lines.empty() ? NearestHit{} : lines_.nearest(p, limit); }

NearestHit InputSurface::nearest_corner(const Vec3& p, double limit) const { return input_.corners.empty() ? NearestHit{} : corners_.nearest(p, limit); }

bool InputSurface::is_on_border(const NearestHit& hit) const {
  const auto c = corners(input_.mesh, hit.triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!input_.is_border[hit.triangle.index()][k]) continue;
    const Vec3 &a = c[k], &b = c[(k + 1) % 3];
    if (distance(hit.point, nearest_on_segment(hit.point, a, b)) <= 1e-6 * distance(a, b)) return true;
  }
  return false;
}

Vec3 InputSurface::normal(TriangleId facet) const {
  const auto c = corners(input_.mesh, facet);
  return normalized(area_vector(c[0], c[1], c[2]));
}

TriMesh wrap_mesh(const std::vector<Vec3>& points, const Facets& triangles) {
  TriMesh mesh;
  mesh.points.raw() = points;
  mesh.triangles.reserve(triangles.size());
  for (const auto& t : triangles) mesh.triangles.push_back({VertexId(t[0]), VertexId(t[1]), VertexId(t[2])});
  return mesh;
}

FittedWrap fit_wrap(const WrapSurface& wrap, const InputSurface& surface, const WrapSizes& sizes, double feature_angle, const RunContext& context) {
  return WrapFitter(wrap, surface, sizes, feature_angle, context).run();
}

}  // namespace sterna::surfmesh
