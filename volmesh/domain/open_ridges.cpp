// Steps: find_edges, choose_vertices, walk_chains (which side of a vertex is which), make_fans, close_gaps. Virtual triangles are what a tiny rounding of the
// edge would be, so all that comes after works as on any wall.
#include "volmesh/domain/open_ridges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"

namespace sterna::volmesh {
namespace {

constexpr double k_raise = 0.01;                 ///< of the first height: how far lines start off their foot, well within the 2 % of gate G11
constexpr double k_least_raise = 1e-11;          ///< of the largest coordinate: virtual triangles have normals of five digits then
constexpr double k_longest_edge = 1e5;           ///< first heights: beyond it control volumes of fans would not be closed to rounding
constexpr double k_bend_cosine = 0.5;            ///< 60 degrees: chains that bend by more end there
constexpr double k_side_cosine = 0.5;            ///< 60 degrees: between the normal of a side and its facets
constexpr double k_far_turn = 182.0 * k_degree;  ///< knife edges turn by 180 degrees up to rounding
constexpr double k_angle_slack = 1e-6;           ///< of fan_angle: no sector for rounding
constexpr double k_clear_axis = 0.1;             ///< sine of the turn above which both normals give its axis

/// One vertex inside a chain, or the one at which it goes on in its mirror image.
struct Inner {
  HalfedgeId ahead, back;       ///< outgoing edges of the chain; one is invalid in a plane on which the wall ends
  double turn = 0.0;            ///< rad, between the normals of both sides
  std::array<Vec3, 2> normal;   ///< unit, of the sides: left and right of the way ahead
  Vec3 axis;                    ///< unit: turns the left normal towards the right one
  std::vector<VertexId> lines;  ///< from left to right
};

class RidgeOpener {
 public:
  RidgeOpener(const RidgeOptions& options, const Column<PatchId, std::uint8_t>& is_open, double first_height, double raise, Domain& domain,
              const RunContext& context)
      : options_(options),
        is_open_(is_open),
        longest_edge_(k_longest_edge * first_height),
        raise_(raise),
        domain_(domain),
        wall_(domain.wall),
        topology_(domain.wall, context),
        is_chain_(topology_.n_halfedges(), 0) {}

  void open(std::span<const VertexId> closed, const RunContext& context) {
    find_edges();
    choose_vertices(closed);
    walk_chains();
    make_fans();
    close_gaps();
    if (domain_.ridges.is_empty()) return;
    context.info("ridges: " + std::to_string(domain_.ridges.feet.size()) + " vertices of the wall have several normals, " +
                 std::to_string(wall_.n_vertices() - domain_.ridges.n_given_vertices) + " more lines");
  }

 private:
  const Point& point(VertexId v) const { return wall_.points[v]; }
  Vec3 normal(TriangleId t) const {
    const auto [a, b, c] = corners(wall_, t);
    return normalized(area_vector(a, b, c));
  }
  /// Whether the wall ends in one plane there, on one patch: ridges go on up to it.
  bool is_in_plane(VertexId v) const { return patch_beyond_[v].is_valid() && domain_.constraints.vertex[v].freedom == Freedom::plane && !is_partner_[v]; }
  bool is_free(VertexId v) const {
    return (domain_.constraints.vertex.empty() || domain_.constraints.vertex[v].freedom == Freedom::free) && !is_partner_[v] &&
           std::ranges::none_of(topology_.outgoing(v), [&](HalfedgeId h) { return topology_.is_boundary(h) || topology_.is_boundary(previous(h)); });
  }

  void find_edges() {
    for (std::size_t i = 0; i < topology_.n_halfedges(); ++i) {
      const HalfedgeId h(i), twin = topology_.twin(h);
      if (!twin.is_valid() || !is_open_[wall_.triangle_patch[triangle_of(h)]] || !is_open_[wall_.triangle_patch[triangle_of(twin)]]) continue;
      const Vec3 own = normal(triangle_of(h)), other = normal(triangle_of(twin));
      const Vec3 along = point(topology_.to(h)) - point(topology_.from(h));
      const double turn = std::atan2(dot(cross(own, other), normalized(along)), dot(own, other));
      is_chain_[h] = turn > options_.open_angle || (turn < 0.0 && turn + 2.0 * std::numbers::pi < k_far_turn) ? 1 : 0;
    }
    for (std::size_t i = 0; i < topology_.n_halfedges(); ++i) {  // knife edges: both senses must agree
      const HalfedgeId h(i);
      if (is_chain_[h] && !is_chain_[topology_.twin(h)]) is_chain_[h] = 0;
    }
  }

  /// Triangles between outgoing half-edges, from one counter-clockwise to the other; an invalid one is the border of the wall.
  std::vector<TriangleId> sector(HalfedgeId from, HalfedgeId to) const {
    std::vector<TriangleId> triangles;
    if (from.is_valid())
      for (HalfedgeId h = from; h.is_valid() && h != to; h = topology_.twin(previous(h))) triangles.push_back(triangle_of(h));
    else
      for (HalfedgeId h = topology_.twin(to); h.is_valid(); h = topology_.twin(next(h))) triangles.push_back(triangle_of(h));
    return triangles;
  }

  VertexId vertex_at(HalfedgeId h) const { return h.is_valid() ? topology_.to(h) : VertexId{}; }
  bool has_fan_at(HalfedgeId h) const { return h.is_valid() && inner_[topology_.to(h)]; }

  /// The normal of one side of a vertex; nothing where it does not see all of it well.
  std::optional<Vec3> side_normal(VertexId v, const std::vector<TriangleId>& side) const {
    Vec3 sum;
    for (const TriangleId t : side) {
      const TriangleVertices& c = wall_.triangles[t];
      const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
      sum += corner_angle(point(v), point(c[(k + 1) % 3]), point(c[(k + 2) % 3])) * normal(t);
    }
    const Vec3 mean = is_in_plane(v) ? constrained(domain_.constraints.vertex[v], sum) : normalized(sum);
    for (const TriangleId t : side)
      if (!(dot(mean, normal(t)) > k_side_cosine)) return {};
    return mean;
  }

  /// Whether a vertex can be one inside a chain; its sides are those of the first edge as the one ahead.
  std::optional<Inner> inner_at(VertexId v) const {
    Inner inner;
    int n = 0;
    for (const HalfedgeId h : topology_.outgoing(v))
      if (is_chain_[h]) (n++ == 0 ? inner.ahead : inner.back) = h;
    if (!(n == 2 && is_free(v)) && !(n == 1 && is_in_plane(v))) return {};
    for (const VertexId w : topology_.neighbours(v))
      if (distance(point(v), point(w)) > longest_edge_) return {};
    return measured(v, inner);
  }

  Vec3 mirrored(VertexId v, const Vec3& way) const {
    const Vec3& normal = domain_.constraints.vertex[v].axis;
    return way - 2.0 * dot(way, normal) * normal;
  }

  /// \pre the edge ahead is there
  std::optional<Inner> measured(VertexId v, Inner inner) const {
    const Vec3 ahead = normalized(point(topology_.to(inner.ahead)) - point(v));
    const Vec3 back = inner.back.is_valid() ? normalized(point(topology_.to(inner.back)) - point(v)) : mirrored(v, ahead);
    if (!(dot(ahead, -back) > k_bend_cosine)) return {};
    const Vec3 along = normalized(ahead - back);
    const std::optional<Vec3> left = side_normal(v, sector(inner.ahead, inner.back)), right = side_normal(v, sector(inner.back, inner.ahead));
    if (!left || !right) return {};
    inner.normal = {*left, *right};
    const Vec3 across = cross(*left, *right);
    inner.turn = std::atan2(dot(across, along), dot(*left, *right));
    if (inner.turn < 0.0) inner.turn += 2.0 * std::numbers::pi;
    if (inner.turn > k_far_turn || inner.turn < 0.5 * options_.open_angle) return {};
    inner.axis = dot(across, along) > k_clear_axis ? normalized(across) : normalized(along - dot(along, *left) * *left);
    return inner;
  }

  void choose_vertices(std::span<const VertexId> closed) {
    is_partner_.resize(wall_.n_vertices(), 0);
    for (const auto& pair : domain_.partners)
      for (const VertexId v : pair) is_partner_[v] = 1;
    patch_beyond_.resize(wall_.n_vertices());
    Column<VertexId, std::uint8_t> has_other(wall_.n_vertices(), 0);
    for (const RimEdge& edge : domain_.rim)
      for (const VertexId v : {topology_.from(edge.halfedge), topology_.to(edge.halfedge)}) {
        has_other[v] = has_other[v] != 0 || (patch_beyond_[v].is_valid() && patch_beyond_[v] != edge.patch) ? 1 : 0;
        patch_beyond_[v] = edge.patch;
      }
    for (const VertexId v : wall_.points.ids())
      if (has_other[v]) patch_beyond_[v] = {};
    inner_.resize(wall_.n_vertices());
    for (const VertexId v : wall_.points.ids()) inner_[v] = inner_at(v);
    for (const VertexId v : closed) {
      if (v.index() >= wall_.n_vertices())
        throw_bad_argument("opening ridges", "vertex " + std::to_string(v.value()) + " is to stay closed, the wall has " + std::to_string(wall_.n_vertices()),
                           {}, "surface and envelope must come from one run");
      inner_[v].reset();
    }
    // Fans need a fan beside them; what is beside the last one is the chain's end, which has to be free.
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      for (const VertexId v : wall_.points.ids()) {
        if (!inner_[v]) continue;
        const HalfedgeId ahead = inner_[v]->ahead, back = inner_[v]->back;
        const auto can_end = [&](HalfedgeId h) { return !h.is_valid() || has_fan_at(h) || is_free(topology_.to(h)); };
        if (vertex_at(ahead) != vertex_at(back) && (has_fan_at(ahead) || has_fan_at(back)) && can_end(ahead) && can_end(back)) continue;
        inner_[v].reset();
        has_changed = true;
      }
    }
  }

  /// Chains as lists of vertices in their order; the edges ahead go along them.
  void walk_chains() {
    Column<VertexId, std::uint8_t> is_done(wall_.n_vertices(), 0);
    const auto turn_round = [&](VertexId v) {
      Inner& inner = *inner_[v];
      std::swap(inner.ahead, inner.back);
      std::swap(inner.normal[0], inner.normal[1]);
      inner.axis = -inner.axis;
    };
    const auto walk = [&](VertexId v) {
      std::vector<VertexId>& chain = chains_.emplace_back();
      while (inner_[v] && !is_done[v]) {
        is_done[v] = 1;
        chain.push_back(v);
        if (!inner_[v]->ahead.is_valid()) break;
        const VertexId next = topology_.to(inner_[v]->ahead);
        if (inner_[next] && !is_done[next] && vertex_at(inner_[next]->back) != v) turn_round(next);
        v = next;
      }
    };
    for (const bool from_ends : {true, false})  // what is left then are loops
      for (const VertexId v : wall_.points.ids()) {
        if (!inner_[v] || is_done[v]) continue;
        const bool is_first = !has_fan_at(inner_[v]->back), is_last = !has_fan_at(inner_[v]->ahead);
        if (from_ends && !is_first && !is_last) continue;
        if (from_ends && !is_first) turn_round(v);
        walk(v);
      }
  }

  /// Along the ridges, m; they do not end in planes.
  Column<VertexId, double> distances_to_ends() const {
    Column<VertexId, double> to_end(wall_.n_vertices(), k_infinity);
    const auto walk = [&](const std::vector<VertexId>& chain, VertexId end) {
      double length = 0.0;
      for (VertexId before = end; const VertexId v : chain) {
        length += distance(point(before), point(v));
        to_end[v] = std::min(to_end[v], length);
        before = v;
      }
    };
    for (const std::vector<VertexId>& chain : chains_) {
      const HalfedgeId first = inner_[chain.front()]->back, last = inner_[chain.back()]->ahead;
      if (has_fan_at(first)) continue;  // a loop
      if (first.is_valid()) walk(chain, topology_.to(first));
      if (last.is_valid()) walk({chain.rbegin(), chain.rend()}, topology_.to(last));
    }
    return to_end;
  }

  /// New vertices, and the given triangles on the right side moved to theirs.
  void make_fans() {
    OpenedRidges& ridges = domain_.ridges;
    ridges.n_given_vertices = wall_.n_vertices();
    ridges.n_given_triangles = wall_.n_triangles();
    const Column<VertexId, double> to_end = distances_to_ends();
    for (const std::vector<VertexId>& chain : chains_) {
      double most = 0.0;
      for (const VertexId v : chain) most = std::max(most, inner_[v]->turn);
      const int n_sectors = std::max(2, static_cast<int>(std::ceil(most / options_.fan_angle - k_angle_slack)));
      for (const VertexId v : chain) {
        Inner& inner = *inner_[v];
        const Point foot = point(v);
        const double half = 0.5 * inner.turn;
        const Vec3 middle = normalized(std::cos(half) * inner.normal[0] + std::sin(half) * cross(inner.axis, inner.normal[0]));
        ridges.feet.push_back({v, foot, middle, std::max(0.0, std::cos(half)), to_end[v]});
        for (int i = 0; i <= n_sectors; ++i) {
          const double angle = inner.turn * i / n_sectors;
          const Vec3 n = i == 0           ? inner.normal[0]
                         : i == n_sectors ? inner.normal[1]
                                          : normalized(std::cos(angle) * inner.normal[0] + std::sin(angle) * cross(inner.axis, inner.normal[0]));
          const Point raised = foot + raise_ * n;
          if (i == 0) {
            inner.lines.push_back(v);
            wall_.points[v] = raised;
          } else {
            inner.lines.push_back(wall_.points.push_back(raised));
          }
        }
        for (const TriangleId t : sector(inner.back, inner.ahead))
          for (VertexId& corner : wall_.triangles[t])
            if (corner == v) corner = inner.lines.back();
      }
    }
    std::ranges::sort(ridges.feet, {}, &OpenedRidges::Foot::vertex);
    if (ridges.is_empty()) return;
    ridges.foot.resize(wall_.n_vertices());
    for (const VertexId v : ridges.foot.ids()) ridges.foot[v] = v;
    for (const std::vector<VertexId>& chain : chains_)
      for (const VertexId v : chain)
        for (const VertexId line : inner_[v]->lines) ridges.foot[line] = v;
  }

  /// Whether a ridge goes on in its mirror image there.
  bool is_at_plane(VertexId v) const { return !inner_[v]->ahead.is_valid() || !inner_[v]->back.is_valid(); }

  /// Lines of a vertex from left to right of the way along an edge that starts (or ends) there.
  std::vector<VertexId> lines_along(VertexId v, bool is_ahead) const {
    std::vector<VertexId> lines = inner_[v]->lines;
    if (!is_ahead) std::ranges::reverse(lines);
    return lines;
  }

  void close_gaps() {
    OpenedRidges& ridges = domain_.ridges;
    for (const std::vector<VertexId>& chain : chains_)
      for (const VertexId v : chain)
        for (const HalfedgeId h : {inner_[v]->ahead, inner_[v]->back}) {
          if (!h.is_valid()) continue;
          const VertexId w = topology_.to(h);
          if (inner_[w] && w < v) continue;  // from there
          const std::vector<VertexId> own = lines_along(v, h == inner_[v]->ahead);
          const PatchId patch = wall_.triangle_patch[triangle_of(h)];
          if (inner_[w]) {
            const std::vector<VertexId> other = lines_along(w, topology_.twin(h) == inner_[w]->back);
            for (std::size_t i = 0; i + 1 < own.size(); ++i) {
              add_quad({other[i], own[i], own[i + 1], other[i + 1]}, h, patch);
              const TriangleId last(wall_.n_triangles() - 1);
              if (is_at_plane(v)) domain_.rim.push_back({halfedge(TriangleId(last.index() - 1), 1), patch_beyond_[v]});
              if (is_at_plane(w)) domain_.rim.push_back({halfedge(last, 2), patch_beyond_[w]});
            }
          } else {
            for (std::size_t i = 0; i + 1 < own.size(); ++i) {
              ridges.ends.push_back({w, own[i], own[i + 1]});
              add_triangle(ridges.ends.back(), h, patch);
            }
            ridges.end_vertices.push_back(w);
          }
        }
    std::ranges::sort(ridges.end_vertices);
    ridges.end_vertices.erase(std::unique(ridges.end_vertices.begin(), ridges.end_vertices.end()), ridges.end_vertices.end());
    if (!domain_.constraints.vertex.empty())
      for (std::size_t i = domain_.constraints.vertex.size(); i < wall_.n_vertices(); ++i)
        domain_.constraints.vertex.push_back(VertexConstraint(domain_.constraints.vertex[ridges.foot[VertexId(i)]]));
    if (!domain_.constraints.near.empty())
      for (std::size_t i = domain_.constraints.near.size(); i < wall_.n_vertices(); ++i)
        domain_.constraints.near.push_back(domain_.constraints.near[ridges.foot[VertexId(i)]]);
  }

  void add_quad(const std::array<VertexId, 4>& q, HalfedgeId beside, PatchId patch) {
    domain_.ridges.quads.push_back(q);
    add_triangle({q[0], q[1], q[2]}, beside, patch);
    add_triangle({q[0], q[2], q[3]}, beside, patch);
  }

  void add_triangle(const std::array<VertexId, 3>& t, HalfedgeId beside, PatchId patch) {
    wall_.triangles.push_back(t);
    wall_.triangle_patch.push_back(patch);
    const TriangleId source = triangle_of(beside);
    if (!domain_.wall2surface.empty()) domain_.wall2surface.push_back(domain_.wall2surface[source]);
    if (!domain_.wall_weights.empty()) domain_.wall_weights.push_back(domain_.wall_weights[source]);
  }

  const RidgeOptions& options_;
  const Column<PatchId, std::uint8_t>& is_open_;
  double longest_edge_, raise_;  ///< m
  Domain& domain_;
  TriMesh& wall_;
  Topology topology_;  ///< of the wall as it was given
  Column<HalfedgeId, std::uint8_t> is_chain_;
  Column<VertexId, std::uint8_t> is_partner_;
  Column<VertexId, PatchId> patch_beyond_;  ///< of the outer boundary, on which the wall ends there; invalid elsewhere, and where there are several
  Column<VertexId, std::optional<Inner>> inner_;
  std::vector<std::vector<VertexId>> chains_;
};

}  // namespace

void open_ridges(const RidgeOptions& options, const Column<PatchId, std::uint8_t>& is_open, double first_height, std::span<const VertexId> closed,
                 Domain& domain, const RunContext& context) {
  if (std::ranges::none_of(is_open, [](std::uint8_t is) { return is != 0; })) return;
  const double raise = k_raise * first_height;
  double largest = 0.0;
  for (const Point& p : domain.wall.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (raise < k_least_raise * largest)
    throw_bad_argument("opening ridges",
                       "the first height of " + number_text(first_height, 3) + " m is too small for coordinates of " + number_text(largest, 3) + " m", {},
                       "move the surface to the origin, or open_ridges = \"never\"");
  RidgeOpener(options, is_open, first_height, raise, domain, context).open(closed, context);
}

}  // namespace sterna::volmesh
