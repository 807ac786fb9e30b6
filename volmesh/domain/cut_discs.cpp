// Steps for each disc: find_active finds the triangles through which the plane passes between the radii; vertices near the plane are moved into it (snap);
// triangles are split; find_outline; find_borders.
#include "volmesh/domain/cut_discs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "volmesh/domain/disc_baffles.h"
#include "volmesh/domain/disc_plane.h"

namespace sterna::volmesh {
namespace {

constexpr double k_snap_share = 0.3;  ///< fraction of an edge: if the plane cuts the edge nearer to an end than this, that end moves into the plane; triangles
                                      ///< keep about a third of their height
constexpr double k_on_plane = 1e-12;  ///< tolerance for vertices in the plane because of rounding, as a fraction of the largest coordinate and the radius
constexpr double k_least_turn_cosine = 0.8;  ///< smallest cosine between the normals of a triangle before and after one of its vertices moves
constexpr double k_least_area_share = 0.2;   ///< smallest fraction of its area that a triangle keeps when a vertex moves
const double k_feature_cosine = std::cos(30.0 * std::numbers::pi / 180.0);  ///< vertices on edges that turn by more than this move only along these edges

class Cutter {
 public:
  Cutter(TriMesh& mesh, const ActuatorDisc& disc, const Column<PatchId, std::uint8_t>& has_layer, const Column<VertexId, std::uint32_t>& taken_by,
         const RunContext& context)
      : mesh_(mesh), disc_(disc), plane_(disc), has_layer_(has_layer), taken_by_(taken_by), context_(context) {}

  /// Returns true if the disc meets walls with layers and no other patch.
  bool find_active() {
    Box box;
    for (const Point& p : mesh_.points) box.add(p);
    double largest = plane_.outer();
    for (const Vec3& corner : {box.min, box.max}) largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    height_.resize(mesh_.n_vertices());
    for (const VertexId v : mesh_.points.ids()) {
      const double h = plane_.height(mesh_.points[v]);
      height_[v] = std::abs(h) <= k_on_plane * largest ? 0.0 : h;
    }
    is_active_.assign(mesh_.n_triangles(), 0);
    std::vector<ErrorLocation> at_borders;
    std::int64_t n_at_borders = 0;
    bool has_any = false, is_layered = true;
    for (const TriangleId t : mesh_.triangles.ids()) {
      const std::optional<std::array<Point, 2>> cut = segment(t);
      if (!cut) continue;
      const Point middle = 0.5 * ((*cut)[0] + (*cut)[1]);
      switch (reach_of(*cut)) {
        case Reach::outside: continue;
        case Reach::border:
          ++n_at_borders;
          if (at_borders.size() < k_max_locations) at_borders.push_back({middle, "the circle of the disc meets patch \"" + name(t) + "\""});
          [[fallthrough]];
        case Reach::inside: break;
      }
      is_active_[t] = has_any = true;
      is_layered = is_layered && has_layer_[mesh_.triangle_patch[t]] != 0;
    }
    if (!has_any || !is_layered) return false;
    if (n_at_borders > 0)
      fail(std::to_string(n_at_borders) + " wall triangles cross the outer or inner circle of the disc", std::move(at_borders), n_at_borders,
           "each circle of the disc must be completely in the fluid or completely inside the body: choose radius and inner_radius so that the circles do not "
           "cross the wall");
    return true;
  }

  void snap() {
    const Topology topology(mesh_, context_);
    for (const TriangleId t : mesh_.triangles.ids()) {
      if (!is_active_[t]) continue;
      for (const VertexId v : mesh_.triangles[t]) {
        if (height_[v] != 0.0) continue;
        mesh_.points[v] = plane_.onto(mesh_.points[v]);
        if (taken_by_[v] != 0)
          fail("the outline of the disc meets the outline of another disc", {{mesh_.points[v], "a vertex of both outlines"}}, 1,
               "move one of the discs: discs must not meet");
      }
    }
    struct Candidate {
      double share;
      VertexId vertex;
      bool operator<(const Candidate& b) const { return share != b.share ? share < b.share : vertex < b.vertex; }
    };
    std::vector<Candidate> candidates;
    for (const TriangleId t : mesh_.triangles.ids()) {
      if (!is_active_[t]) continue;
      for (int k = 0; k < 3; ++k) {
        const VertexId a = topology.from(halfedge(t, k)), b = topology.to(halfedge(t, k));
        if (!crosses(a, b)) continue;
        const double share = share_of(a, b);
        if (share < k_snap_share) candidates.push_back({share, a});
        if (1.0 - share < k_snap_share) candidates.push_back({1.0 - share, b});
      }
    }
    std::sort(candidates.begin(), candidates.end());
    for (const Candidate& candidate : candidates) snap(topology, candidate.vertex);
  }

  /// Splits triangles. The source triangle of each new triangle is appended to `made`.
  Column<TriangleId, TriangleId> split() {
    Column<TriangleId, TriangleVertices> triangles;
    Column<TriangleId, PatchId> patches;
    Column<TriangleId, TriangleId> made;
    const auto add = [&](TriangleId from, VertexId a, VertexId b, VertexId c) {
      triangles.push_back({a, b, c});
      patches.push_back(mesh_.triangle_patch[from]);
      made.push_back(from);
    };
    for (const TriangleId t : mesh_.triangles.ids()) {
      const TriangleVertices v = mesh_.triangles[t];
      std::array<bool, 3> is_cut{};  // entry k: the plane cuts the edge from corner k
      int n_cut = 0;
      for (std::size_t k = 0; is_active_[t] && k < 3; ++k) n_cut += is_cut[k] = crosses(v[k], v[(k + 1) % 3]);
      if (n_cut == 0) {
        add(t, v[0], v[1], v[2]);
        continue;
      }
      // The corners are rotated so that a single cut edge is opposite to the first corner, or so that two cut edges meet at the first corner.
      std::size_t first = 0;
      while (n_cut == 1 ? !is_cut[(first + 1) % 3] : is_cut[(first + 1) % 3]) ++first;
      const VertexId a = v[first], b = v[(first + 1) % 3], c = v[(first + 2) % 3];
      if (n_cut == 1) {
        const VertexId m = cut_point(b, c);
        add(t, a, b, m);
        add(t, a, m, c);
        continue;
      }
      const VertexId m = cut_point(a, b), n = cut_point(a, c);
      add(t, a, m, n);
      const double to_c = distance(mesh_.points[m], mesh_.points[c]), to_b = distance(mesh_.points[b], mesh_.points[n]);
      if (to_c < to_b || (to_c == to_b && c < b)) {
        add(t, m, b, c);
        add(t, m, c, n);
      } else {
        add(t, m, b, n);
        add(t, b, c, n);
      }
    }
    mesh_.triangles = std::move(triangles);
    mesh_.triangle_patch = std::move(patches);
    Column<TriangleId, std::uint8_t> is_active;
    for (const TriangleId from : made) is_active.push_back(is_active_[from]);
    is_active_ = std::move(is_active);
    return made;
  }

  CutDisc find_outline() {
    struct Sides {
      int upstream = 0, downstream = 0;
      std::array<VertexId, 2> edge;  ///< oriented as in the upstream triangle
    };
    std::map<std::array<VertexId, 2>, Sides> edges;
    std::map<VertexId, int> degree;
    std::vector<ErrorLocation> locations;
    std::int64_t n_locations = 0;
    const auto complain = [&](const Point& p, const char* what) {
      ++n_locations;
      if (locations.size() < k_max_locations) locations.push_back({p, what});
    };
    for (const TriangleId t : mesh_.triangles.ids()) {
      if (!is_active_[t]) continue;
      const TriangleVertices& v = mesh_.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3];
        if (height_[a] == 0.0) degree.try_emplace(a, 0);
        if (height_[a] != 0.0 || height_[b] != 0.0) continue;
        if (height_[c] == 0.0) {
          if (k == 0) complain((mesh_.points[a] + mesh_.points[b] + mesh_.points[c]) / 3.0, "a triangle of the wall lies in the plane of the disc");
          continue;
        }
        Sides& sides = edges[{std::min(a, b), std::max(a, b)}];
        (height_[c] < 0.0 ? sides.upstream : sides.downstream) += 1;
        if (height_[c] < 0.0) sides.edge = {a, b};
      }
    }
    CutDisc cut;
    for (const auto& [key, sides] : edges) {
      if (sides.upstream != 1 || sides.downstream != 1) {
        complain(0.5 * (mesh_.points[key[0]] + mesh_.points[key[1]]), "an edge of the wall touches the plane of the disc");
        continue;
      }
      cut.outline.push_back(sides.edge);
      ++degree[key[0]];
      ++degree[key[1]];
    }
    for (const auto& [edge, point] : cut_points_)
      if (point.n_uses != 2) complain(mesh_.points[point.vertex], "the circle of the disc is too close to the wall");
    for (const auto& [v, n] : degree)
      if (n != 2) complain(mesh_.points[v], n == 0 ? "the wall touches the plane of the disc" : "outlines of the disc meet");
    if (n_locations > 0)
      fail("the wall touches the plane of the disc at " + std::to_string(n_locations) + " locations without crossing it", std::move(locations), n_locations,
           "move the disc along its axis, by some edge lengths of the wall");
    find_borders(cut);
    return cut;
  }

 private:
  enum class Reach { outside, inside, border };

  [[noreturn]] void fail(std::string problem, std::vector<ErrorLocation> locations, std::int64_t n_locations, std::string hint) const {
    throw Error({.code = ErrorCode::self_intersection,
                 .attempted = "making actuator disc \"" + disc_.name + "\"",
                 .problem = std::move(problem),
                 .locations = std::move(locations),
                 .n_locations = n_locations,
                 .hint = std::move(hint)});
  }
  const std::string& name(TriangleId t) const { return mesh_.patches[mesh_.triangle_patch[t]].name; }
  bool crosses(VertexId a, VertexId b) const { return (height_[a] < 0.0 && height_[b] > 0.0) || (height_[a] > 0.0 && height_[b] < 0.0); }
  /// Returns the fraction of the way from a to b at which the plane cuts.
  double share_of(VertexId a, VertexId b) const { return height_[a] / (height_[a] - height_[b]); }
  Point cut_location(VertexId a, VertexId b) const {
    if (b < a) std::swap(a, b);
    return plane_.onto(mesh_.points[a] + share_of(a, b) * (mesh_.points[b] - mesh_.points[a]));
  }

  /// Returns the section of the triangle with the plane; nothing if the section is a point.
  std::optional<std::array<Point, 2>> segment(TriangleId t) const {
    const TriangleVertices& v = mesh_.triangles[t];
    std::array<Point, 6> ends;
    std::size_t n = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (height_[v[k]] == 0.0) ends[n++] = plane_.onto(mesh_.points[v[k]]);
      if (crosses(v[k], v[(k + 1) % 3])) ends[n++] = cut_location(v[k], v[(k + 1) % 3]);
    }
    if (n < 2) return std::nullopt;
    return std::array{ends[0], ends[1]};
  }

  Reach reach_of(const std::array<Point, 2>& cut) const {
    const double a = norm(cut[0] - plane_.center()), b = norm(cut[1] - plane_.center());
    const Vec3 along = cut[1] - cut[0];
    const double length2 = norm2(along);
    const double share = length2 > 0.0 ? std::clamp(dot(plane_.center() - cut[0], along) / length2, 0.0, 1.0) : 0.0;
    const double nearest = norm(cut[0] + share * along - plane_.center());
    if (nearest >= plane_.outer() || std::max(a, b) <= plane_.inner()) return Reach::outside;
    return std::max(a, b) < plane_.outer() && (plane_.inner() == 0.0 || nearest > plane_.inner()) ? Reach::inside : Reach::border;
  }

  VertexId cut_point(VertexId a, VertexId b) {
    const std::array<VertexId, 2> key = {std::min(a, b), std::max(a, b)};
    const auto [found, is_new] = cut_points_.try_emplace(key);
    if (!is_new) {
      ++found->second.n_uses;
      return found->second.vertex;
    }
    if (taken_by_[a] != 0 && taken_by_[a] == taken_by_[b])
      fail("the outline of the disc meets the outline of another disc", {{cut_location(a, b), "an edge of both outlines"}}, 1,
           "move one of the discs: discs must not meet");
    found->second = {mesh_.points.push_back(cut_location(a, b)), 1};
    height_.push_back(0.0);
    return found->second.vertex;
  }

  bool is_feature(const Topology& topology, HalfedgeId h) const {
    const HalfedgeId twin = topology.twin(h);
    const TriangleId t = triangle_of(h), u = triangle_of(twin);
    if (mesh_.triangle_patch[t] != mesh_.triangle_patch[u]) return true;
    return dot(normalized(area_of(t)), normalized(area_of(u))) < k_feature_cosine;
  }
  Vec3 area_of(TriangleId t) const {
    const auto [a, b, c] = corners(mesh_, t);
    return area_vector(a, b, c);
  }

  /// Moves a vertex into the plane along its shortest cut edge, if the plane still cuts an edge near the vertex and nothing prevents the move.
  void snap(const Topology& topology, VertexId v) {
    if (height_[v] == 0.0 || taken_by_[v] != 0) return;
    std::size_t n_features = 0;
    for (const HalfedgeId h : topology.outgoing(v)) n_features += is_feature(topology, h);
    if (n_features == 1 || n_features > 2) return;  // the vertex is a corner
    HalfedgeId best;
    double least = 0.0;
    for (const HalfedgeId h : topology.outgoing(v)) {
      const VertexId w = topology.to(h);
      if (!is_active_[triangle_of(h)] || !crosses(v, w) || share_of(v, w) >= k_snap_share) continue;
      if (n_features == 2 && !is_feature(topology, h)) continue;
      const double length = share_of(v, w) * distance(mesh_.points[v], mesh_.points[w]);
      if (best.is_valid() && length >= least) continue;
      best = h;
      least = length;
    }
    if (!best.is_valid()) return;
    std::vector<Vec3> before;
    for (const HalfedgeId h : topology.outgoing(v)) before.push_back(area_of(triangle_of(h)));
    const Point old = mesh_.points[v];
    const double old_height = height_[v];
    mesh_.points[v] = cut_location(v, topology.to(best));
    height_[v] = 0.0;
    std::size_t i = 0;
    for (const HalfedgeId h : topology.outgoing(v)) {
      const Vec3 now = area_of(triangle_of(h)), was = before[i++];
      const bool is_flat = std::ranges::all_of(mesh_.triangles[triangle_of(h)], [&](VertexId w) { return height_[w] == 0.0; });
      if (!is_flat && dot(now, was) > k_least_turn_cosine * norm(now) * norm(was) && norm(now) > k_least_area_share * norm(was)) continue;
      mesh_.points[v] = old;
      height_[v] = old_height;
      return;
    }
    // The plane now passes through all triangles at this vertex, including those that it did not cut before.
    for (const HalfedgeId h : topology.outgoing(v)) is_active_[triangle_of(h)] = 1;
  }

  /// Finds which boundary circles of the disc lie in the fluid. There the winding number of all sections of the boundary with the plane is one (the outermost
  /// part contributes +1, bodies -1).
  void find_borders(CutDisc& cut) const {
    const Vec3 n = plane_.normal();
    const Vec3 m{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const Vec3 u = normalized(cross(n, m.x <= m.y && m.x <= m.z ? Vec3{1, 0, 0} : m.y <= m.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
    const auto is_fluid = [&](double radius) {
      const Point p = plane_.center() + radius * u;
      double turn = 0.0;
      for (const TriangleId t : mesh_.triangles.ids()) {
        // Vertices in the plane count as downstream, so that sections are closed.
        const TriangleVertices& v = mesh_.triangles[t];
        Point in, out;
        int n_ends = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const VertexId a = v[k], b = v[(k + 1) % 3];
          if ((height_[a] < 0.0) == (height_[b] < 0.0)) continue;
          (height_[a] < 0.0 ? in : out) = height_[a] == 0.0   ? plane_.onto(mesh_.points[a])
                                          : height_[b] == 0.0 ? plane_.onto(mesh_.points[b])
                                                              : cut_location(a, b);
          ++n_ends;
        }
        if (n_ends != 2) continue;
        const Vec3 from = in - p, to = out - p;
        turn += std::atan2(dot(n, cross(from, to)), dot(from, to));
      }
      return turn > std::numbers::pi;
    };
    cut.has_outer_border = is_fluid(plane_.outer());
    cut.has_inner_border = plane_.inner() > 0.0 && is_fluid(plane_.inner());
  }

  TriMesh& mesh_;
  const ActuatorDisc& disc_;
  DiscPlane plane_;
  const Column<PatchId, std::uint8_t>& has_layer_;
  const Column<VertexId, std::uint32_t>& taken_by_;
  const RunContext& context_;
  Column<VertexId, double> height_;             ///< height above the plane; exactly 0 for vertices in the plane
  Column<TriangleId, std::uint8_t> is_active_;  ///< the disc's plane cuts the triangle between the radii
  struct CutPoint {
    VertexId vertex;
    int n_uses = 0;  ///< number of triangles at the edge; two are normal
  };
  std::map<std::array<VertexId, 2>, CutPoint> cut_points_;
};

}  // namespace

DiscCuts cut_discs(TriMesh& boundary, const Column<PatchId, std::uint8_t>& has_layer, const std::vector<ActuatorDisc>& discs, const RunContext& context) {
  DiscCuts cuts;
  Column<VertexId, std::uint32_t> taken_by(boundary.n_vertices(), 0);  // index of the disc whose outline uses the vertex, counted from 1
  for (std::size_t i = 0; i < discs.size(); ++i) {
    require_sane(discs[i]);
    Cutter cutter(boundary, discs[i], has_layer, taken_by, context);
    if (!cutter.find_active()) continue;
    cutter.snap();
    Column<TriangleId, TriangleId> made = cutter.split();
    if (!cuts.sources.empty())
      for (TriangleId& from : made) from = cuts.sources[from];
    cuts.sources = std::move(made);
    CutDisc cut = cutter.find_outline();
    cut.disc = i;
    taken_by.resize(boundary.n_vertices(), 0);
    for (const auto& edge : cut.outline)
      for (const VertexId v : edge) taken_by[v] = static_cast<std::uint32_t>(i) + 1;
    cuts.discs.push_back(std::move(cut));
    context.check_stop();
  }
  return cuts;
}

}  // namespace sterna::volmesh
