// Steps: find_edges, choose_vertices, walk_chains (finds which side of a vertex is left and which is right), make_multi_normals, make_corners, close_gaps.
// Virtual triangles are equivalent to a tiny rounding of the edge, so all later steps work as on any other wall.
#include "volmesh/domain/open_ridges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <queue>
#include <string>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/sort_unique.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"
#include "volmesh/domain/ridge_corner.h"

namespace sterna::volmesh {
namespace {

/// Fraction of the first height: distance of the starts of growth lines from their ridge base vertex, well within the 2 % of gate G11.
constexpr double k_raise = 0.01;
/// Lower limit of that distance, as a fraction of the largest coordinate: normals of virtual triangles then have five digits.
constexpr double k_least_raise = 1e-11;
constexpr double k_longest_edge = 1e5;           ///< in first heights: on longer edges, control volumes of multi-normal fans would not be closed to rounding
constexpr double k_bend_cosine = 0.5;            ///< 60 degrees: chains end at larger bends between edges
constexpr double k_side_cosine = 0.5;            ///< 60 degrees: largest angle between the normal of a side and its facets
constexpr double k_far_turn = 182.0 * k_degree;  ///< 180 degrees and a margin for rounding: the turn of a knife edge
constexpr double k_angle_slack = 1e-6;           ///< relative to fan_angle: rounding must not add a sector
constexpr double k_clear_axis = 0.1;             ///< sine of the turn; above it the two normals define the axis of the turn

/// A vertex inside a chain, or a vertex at which the chain continues in its mirror image.
struct Inner {
  HalfedgeId ahead, back;       ///< outgoing edges of the chain, ahead and back; one is invalid in a plane in which the wall ends
  RidgeTurn turn;               ///< turn from the normal of one side to that of the other
  std::array<Vec3, 2> normal;   ///< unit normals of the sides to the left and right of the direction ahead
  std::vector<VertexId> lines;  ///< growth lines from left to right
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

  void open(std::span<const VertexId> closed) {
    find_edges();
    choose_vertices(closed);
    walk_chains();
    make_multi_normals();
    make_corners();
    if (domain_.ridges.is_empty()) return;
    number_base_vertices();
    close_gaps();
    pair_lines();
  }

 private:
  const Point& point(VertexId v) const { return wall_.points[v]; }
  Vec3 normal(TriangleId t) const {
    const auto [a, b, c] = corners(wall_, t);
    return normalized(area_vector(a, b, c));
  }
  /// Returns true if the wall ends at v in one plane, on one patch. Ridges continue up to that plane. (At periodic sides there are two planes, and the ridge
  /// continues at the other side.)
  bool is_in_plane(VertexId v) const {
    if (!patch_beyond_[v].is_valid() || domain_.constraints.vertex[v].freedom != Freedom::plane) return false;
    return !is_partner_[v] || partner_[v].is_valid();
  }
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
    for (std::size_t i = 0; i < topology_.n_halfedges(); ++i) {  // for knife edges both directions must agree
      const HalfedgeId h(i);
      if (is_chain_[h] && !is_chain_[topology_.twin(h)]) is_chain_[h] = 0;
    }
  }

  /// Returns the triangles between two outgoing half-edges, counter-clockwise. An invalid half-edge means the border of the wall.
  std::vector<TriangleId> sector(HalfedgeId from, HalfedgeId to) const {
    std::vector<TriangleId> triangles;
    if (from.is_valid())
      for (HalfedgeId h = from; h.is_valid() && h != to; h = topology_.twin(previous(h))) triangles.push_back(triangle_of(h));
    else
      for (HalfedgeId h = topology_.twin(to); h.is_valid(); h = topology_.twin(next(h))) triangles.push_back(triangle_of(h));
    return triangles;
  }

  bool is_inner_at(HalfedgeId h) const { return h.is_valid() && inner_[topology_.to(h)]; }
  VertexId vertex_at(HalfedgeId h) const { return h.is_valid() ? topology_.to(h) : VertexId{}; }
  bool has_multi_normal(VertexId v) const { return inner_[v] || corners_.contains(v); }
  bool has_multi_normal_at(HalfedgeId h) const { return h.is_valid() && has_multi_normal(topology_.to(h)); }
  /// Returns true if a chain may end here. A multi-normal fan needs an adjacent fan. The vertex after the last fan is the end of the chain, and it must be
  /// free.
  bool can_end(HalfedgeId h) const { return !h.is_valid() || has_multi_normal_at(h) || is_free(topology_.to(h)); }

  /// Returns the sum of the normals of the triangles on one side of a vertex, weighted by their angles at the vertex.
  Vec3 sum_of_normals(VertexId v, const std::vector<TriangleId>& side) const {
    Vec3 sum;
    for (const TriangleId t : side) {
      const TriangleVertices& c = wall_.triangles[t];
      const std::size_t k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
      sum += corner_angle(point(v), point(c[(k + 1) % 3]), point(c[(k + 2) % 3])) * normal(t);
    }
    return sum;
  }

  bool sees(const Vec3& direction, const std::vector<TriangleId>& side) const {
    return std::ranges::all_of(side, [&](TriangleId t) { return dot(direction, normal(t)) > k_side_cosine; });
  }

  /// Returns the normal of one side of a vertex; nothing if some triangles of the side are not well visible from it.
  std::optional<Vec3> side_normal(VertexId v, const std::vector<TriangleId>& side) const {
    const Vec3 sum = sum_of_normals(v, side), mean = is_in_plane(v) ? constrained(domain_.constraints.vertex[v], sum) : normalized(sum);
    if (!sees(mean, side)) return {};
    return mean;
  }

  /// Returns the left and right normals of a vertex on a periodic side. They are computed from its triangles and those of its partner, and are bit-identical
  /// for both.
  std::optional<std::array<Vec3, 2>> periodic_normals(VertexId v, HalfedgeId ahead, HalfedgeId of_partner) const {
    struct End {
      VertexId vertex;
      HalfedgeId edge;
    };
    const VertexId partner = partner_[v];
    const End first = v < partner ? End{v, ahead} : End{partner, of_partner}, second = v < partner ? End{partner, of_partner} : End{v, ahead};
    const auto normal_of = [&](const std::vector<TriangleId>& a, const std::vector<TriangleId>& b) -> std::optional<Vec3> {
      const Vec3 mean = constrained(domain_.constraints.vertex[first.vertex], sum_of_normals(first.vertex, a) + sum_of_normals(second.vertex, b));
      if (!sees(mean, a) || !sees(mean, b)) return {};
      return mean;
    };
    // The directions ahead of both partners are opposite: the left side of one is the right side of the other.
    const std::optional<Vec3> left = normal_of(sector(first.edge, {}), sector({}, second.edge)),
                              right = normal_of(sector({}, first.edge), sector(second.edge, {}));
    if (!left || !right) return {};
    if (v == first.vertex) return std::array{*left, *right};
    return std::array{*right, *left};
  }

  /// Returns the ridge edge at a vertex that has exactly one; otherwise an invalid half-edge.
  HalfedgeId only_edge(VertexId v) const {
    HalfedgeId edge;
    for (const HalfedgeId h : topology_.outgoing(v)) {
      if (!is_chain_[h]) continue;
      if (edge.is_valid()) return {};
      edge = h;
    }
    return edge;
  }

  /// Returns the vertex data if a vertex can be inside a chain. Left and right refer to the direction of the first edge, which is the edge ahead.
  std::optional<Inner> inner_at(VertexId v) const {
    Inner inner;
    int n = 0;
    for (const HalfedgeId h : topology_.outgoing(v))
      if (is_chain_[h]) (n++ == 0 ? inner.ahead : inner.back) = h;
    if (!(n == 2 && is_free(v)) && !(n == 1 && is_in_plane(v))) return {};
    if (has_long_edge(v)) return {};
    return measured(v, inner);
  }

  bool has_long_edge(VertexId v) const {
    return std::ranges::any_of(topology_.neighbours(v), [&](VertexId w) { return distance(point(v), point(w)) > longest_edge_; });
  }

  /// Returns the angle from one normal to another in rad, from 0 to two pi.
  static double turn_about(const Vec3& along, const Vec3& left, const Vec3& right) {
    const double angle = std::atan2(dot(cross(left, right), along), dot(left, right));
    return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
  }

  /// Returns the corner if a vertex can be one. \pre it is not inside a chain
  std::optional<RidgeCorner> corner_at(VertexId v) const {
    RidgeCorner corner;
    for (const HalfedgeId h : topology_.outgoing(v))
      if (is_chain_[h]) corner.edges.push_back(h);
    if (corner.edges.size() < 2 || !is_free(v) || has_long_edge(v)) return {};
    const HalfedgeId first = corner.edges.front();
    corner.edges.resize(1);
    for (HalfedgeId h = topology_.twin(previous(first)); h != first; h = topology_.twin(previous(h)))
      if (is_chain_[h]) corner.edges.push_back(h);
    const std::size_t n = corner.edges.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::optional<Vec3> side = side_normal(v, sector(corner.edges[i], corner.edges[(i + 1) % n]));
      if (!side) return {};
      corner.normal.push_back(*side);
    }
    for (const HalfedgeId h : corner.edges) {
      const Vec3 along = normalized(point(topology_.to(h)) - point(v));
      corner.facet.push_back(normal(triangle_of(h)));
      corner.turn.push_back({turn_about(along, corner.facet.back(), normal(triangle_of(topology_.twin(h)))), along});
    }
    corner.n_sectors.assign(n, 0);
    return corner;
  }

  int n_sectors(double turn) const { return std::max(2, static_cast<int>(std::ceil(turn / options_.fan_angle - k_angle_slack))); }

  /// Returns true if the growth lines form an open corner, with as many sectors as each of its ridges would have without the corner.
  bool is_open_corner(RidgeCorner corner) const {
    for (std::size_t i = 0; i < corner.edges.size(); ++i) corner.n_sectors[i] = n_sectors(corner.turn[i].angle);
    return corner.is_star();
  }

  Vec3 mirrored(VertexId v, const Vec3& way) const {
    const Vec3& normal = domain_.constraints.vertex[v].axis;
    return way - 2.0 * dot(way, normal) * normal;
  }

  /// Returns the vertex data with its measured turn. \pre the edge ahead exists
  std::optional<Inner> measured(VertexId v, Inner inner) const {
    const Vec3 ahead = normalized(point(topology_.to(inner.ahead)) - point(v));
    Vec3 back;
    std::optional<Vec3> left, right;
    if (!inner.back.is_valid() && partner_[v].is_valid()) {
      const HalfedgeId beyond = only_edge(partner_[v]);
      if (!beyond.is_valid() || !is_in_plane(partner_[v])) return {};
      back = normalized(point(topology_.to(beyond)) - point(partner_[v]));
      if (const auto both = periodic_normals(v, inner.ahead, beyond)) left = (*both)[0], right = (*both)[1];
    } else {
      back = inner.back.is_valid() ? normalized(point(topology_.to(inner.back)) - point(v)) : mirrored(v, ahead);
      left = side_normal(v, sector(inner.ahead, inner.back));
      right = side_normal(v, sector(inner.back, inner.ahead));
    }
    if (!left || !right || !(dot(ahead, -back) > k_bend_cosine)) return {};
    const Vec3 along = normalized(ahead - back);
    inner.normal = {*left, *right};
    const Vec3 across = cross(*left, *right);
    inner.turn.angle = turn_about(along, *left, *right);
    if (inner.turn.angle > k_far_turn || inner.turn.angle < 0.5 * options_.open_angle) return {};
    inner.turn.axis = dot(across, along) > k_clear_axis ? normalized(across) : normalized(along - dot(along, *left) * *left);
    return inner;
  }

  void choose_vertices(std::span<const VertexId> closed) {
    is_partner_.resize(wall_.n_vertices(), 0);
    partner_.resize(wall_.n_vertices());
    for (const auto& pair : domain_.partners)
      for (std::size_t k = 0; k < 2; ++k) {
        partner_[pair[k]] = is_partner_[pair[k]] == 0 ? pair[1 - k] : VertexId{};  // valid only for vertices with a single partner
        is_partner_[pair[k]] = 1;
      }
    patch_beyond_.resize(wall_.n_vertices());
    Column<VertexId, std::uint8_t> has_other(wall_.n_vertices(), 0);
    for (const LayerBorderEdge& edge : domain_.border)
      for (const VertexId v : {topology_.from(edge.halfedge), topology_.to(edge.halfedge)}) {
        has_other[v] = has_other[v] != 0 || (patch_beyond_[v].is_valid() && patch_beyond_[v] != edge.patch) ? 1 : 0;
        patch_beyond_[v] = edge.patch;
      }
    for (const VertexId v : wall_.points.ids())
      if (has_other[v]) patch_beyond_[v] = {};
    inner_.resize(wall_.n_vertices());
    for (const VertexId v : wall_.points.ids()) {
      inner_[v] = inner_at(v);
      if (inner_[v]) continue;
      if (std::optional<RidgeCorner> corner = corner_at(v); corner && is_open_corner(*corner)) corners_.emplace(v, std::move(*corner));
    }
    for (const VertexId v : closed) {
      if (v.index() >= wall_.n_vertices())
        throw_bad_argument("opening ridges",
                           "vertex " + std::to_string(v.value()) + " is marked as closed ridge vertex, but the number of wall vertices is " +
                               std::to_string(wall_.n_vertices()),
                           {}, "surface and envelope must come from one run");
      inner_[v].reset();
      corners_.erase(v);
    }
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      for (const VertexId v : wall_.points.ids()) {
        if (!inner_[v]) continue;
        const HalfedgeId ahead = inner_[v]->ahead, back = inner_[v]->back;
        const bool goes_on = !partner_[v].is_valid() || inner_[partner_[v]];
        if (goes_on && vertex_at(ahead) != vertex_at(back) && (has_multi_normal_at(ahead) || has_multi_normal_at(back)) && can_end(ahead) && can_end(back))
          continue;
        inner_[v].reset();
        has_changed = true;
      }
      const auto cannot_be = [&](const auto& entry) {
        const std::vector<HalfedgeId>& edges = entry.second.edges;
        return std::ranges::count_if(edges, [&](HalfedgeId h) { return has_multi_normal_at(h); }) < 2 ||
               !std::ranges::all_of(edges, [&](HalfedgeId h) { return can_end(h); });
      };
      if (std::erase_if(corners_, cannot_be) > 0) has_changed = true;
    }
  }

  /// Collects chains as lists of vertices in their order; the edges ahead point along them.
  void walk_chains() {
    Column<VertexId, std::uint8_t> is_done(wall_.n_vertices(), 0);
    const auto turn_round = [&](VertexId v) {
      Inner& inner = *inner_[v];
      std::swap(inner.ahead, inner.back);
      std::swap(inner.normal[0], inner.normal[1]);
      inner.turn.axis = -inner.turn.axis;
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
    for (const bool from_ends : {true, false})  // the chains that remain in the second pass are loops
      for (const VertexId v : wall_.points.ids()) {
        if (!inner_[v] || is_done[v]) continue;
        const bool is_first = !is_inner_at(inner_[v]->back), is_last = !is_inner_at(inner_[v]->ahead);
        if (from_ends && !is_first && !is_last) continue;
        if (from_ends && !is_first) turn_round(v);
        walk(v);
      }
  }

  /// Returns the distance of each vertex to the nearest end along the ridges, m. A plane is no end of a ridge.
  Column<VertexId, double> distances_to_ends() const {
    Column<VertexId, double> to_end(wall_.n_vertices(), k_infinity);
    using Reached = std::pair<double, VertexId>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    const auto reach = [&](VertexId v, double length) {
      if (!(length < to_end[v])) return;
      to_end[v] = length;
      front.emplace(length, v);
    };
    const auto for_each_edge_of = [&](VertexId v, const auto& f) {
      if (inner_[v]) {
        for (const HalfedgeId h : {inner_[v]->back, inner_[v]->ahead})
          if (h.is_valid()) f(h);
      } else
        for (const HalfedgeId h : corners_.at(v).edges) f(h);
    };
    for (const VertexId v : wall_.points.ids())
      if (has_multi_normal(v))
        for_each_edge_of(v, [&](HalfedgeId h) {
          if (!has_multi_normal_at(h)) reach(v, distance(point(v), point(topology_.to(h))));
        });
    while (!front.empty()) {
      const auto [length, v] = front.top();
      front.pop();
      if (length > to_end[v]) continue;
      for_each_edge_of(v, [&](HalfedgeId h) {
        if (has_multi_normal_at(h)) reach(topology_.to(h), length + distance(point(v), point(topology_.to(h))));
      });
      if (partner_[v].is_valid()) reach(partner_[v], length);
    }
    return to_end;
  }

  /// Creates the new vertices. Moves the given triangles on the right side to the new vertices there.
  void make_multi_normals() {
    OpenedRidges& ridges = domain_.ridges;
    ridges.n_given_vertices = wall_.n_vertices();
    ridges.n_given_triangles = wall_.n_triangles();
    to_end_ = distances_to_ends();
    given_ = wall_.points;
    std::vector<double> most(chains_.size(), 0.0);  // largest turn along each chain, including chains in which it continues at periodic sides
    Column<VertexId, std::size_t> chain_of(wall_.n_vertices(), 0);
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      for (const VertexId v : chains_[c]) {
        most[c] = std::max(most[c], inner_[v]->turn.angle);
        chain_of[v] = c;
      }
      for (const HalfedgeId h : ways_out(chains_[c]))
        if (const RidgeCorner* const corner = corner_beyond(h)) most[c] = std::max(most[c], corner->turn[corner->edge_number(topology_.twin(h))].angle);
    }
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      for (const auto& pair : domain_.partners) {
        if (!has_multi_normal_pair(pair)) continue;
        double &one = most[chain_of[pair[0]]], &other = most[chain_of[pair[1]]];
        if (one == other) continue;
        one = other = std::max(one, other);
        has_changed = true;
      }
    }
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      const std::vector<VertexId>& chain = chains_[c];
      const std::array<HalfedgeId, 2> out = ways_out(chain);
      const int n = n_sectors(most[c]);
      for (const HalfedgeId h : out)
        if (RidgeCorner* const corner = corner_beyond(h)) corner->n_sectors[corner->edge_number(topology_.twin(h))] = n;
      for (const VertexId v : chain) {
        Inner& inner = *inner_[v];
        const double half = 0.5 * inner.turn.angle;
        ridges.base_vertices.push_back({v, given_[v], inner.turn.turned(inner.normal[0], half), std::max(0.0, std::cos(half)), to_end_[v]});
        for (int i = 0; i <= n; ++i)
          inner.lines.push_back(new_line(v, i == 0,
                                         i == 0   ? inner.normal[0]
                                         : i == n ? inner.normal[1]
                                                  : inner.turn.turned(inner.normal[0], inner.turn.angle * i / n)));
        move_triangles(v, sector(inner.back, inner.ahead), inner.lines.back());
      }
    }
  }

  /// Returns the edges beyond the first and the last vertex of the chain.
  std::array<HalfedgeId, 2> ways_out(const std::vector<VertexId>& chain) const { return {inner_[chain.front()]->back, inner_[chain.back()]->ahead}; }

  bool has_multi_normal_pair(const std::array<VertexId, 2>& pair) const {
    return std::ranges::all_of(pair, [&](VertexId v) { return v.index() < inner_.size() && inner_[v] && partner_[v].is_valid(); });
  }

  /// Pairs the growth lines of multi-normal fans on periodic sides with the growth lines on the other side.
  void pair_lines() {
    std::vector<std::array<VertexId, 2>> more;
    for (auto& pair : domain_.partners) {
      if (!has_multi_normal_pair(pair)) continue;
      const std::vector<VertexId> one = lines_along(edge_at(pair[0])), other = lines_along(edge_at(pair[1]));
      pair = {one.front(), other.back()};
      for (std::size_t i = 1; i < one.size(); ++i) more.push_back({one[i], other[one.size() - 1 - i]});
    }
    domain_.partners.insert(domain_.partners.end(), more.begin(), more.end());
  }
  /// Returns the edge of the chain at a vertex that lies in a plane.
  HalfedgeId edge_at(VertexId v) const { return inner_[v]->ahead.is_valid() ? inner_[v]->ahead : inner_[v]->back; }

  RidgeCorner* corner_beyond(HalfedgeId h) {
    if (!h.is_valid()) return nullptr;
    const auto found = corners_.find(topology_.to(h));
    return found == corners_.end() ? nullptr : &found->second;
  }

  /// Creates a growth line. \param is_first true: the line reuses the vertex itself; false: a new vertex is added
  VertexId new_line(VertexId v, bool is_first, const Vec3& normal) {
    const Point raised = given_[v] + raise_ * normal;
    if (!is_first) return wall_.points.push_back(raised);
    wall_.points[v] = raised;
    return v;
  }

  void move_triangles(VertexId v, const std::vector<TriangleId>& side, VertexId line) {
    for (const TriangleId t : side)
      for (VertexId& corner : wall_.triangles[t])
        if (corner == v) corner = line;
  }

  void make_corners() {
    for (auto& [v, corner] : corners_) {
      const std::size_t n = corner.edges.size();
      for (std::size_t i = 0; i < n; ++i) {
        if (corner.n_sectors[i] > 0) continue;  // the edge belongs to a chain
        double most = corner.turn[i].angle;
        if (const RidgeCorner* const other = corner_beyond(corner.edges[i]))
          most = std::max(most, other->turn[other->edge_number(topology_.twin(corner.edges[i]))].angle);
        corner.n_sectors[i] = n_sectors(most);
      }
      std::vector<VertexId> of_side;
      for (std::size_t i = 0; i < n; ++i) of_side.push_back(new_line(v, i == 0, corner.normal[i]));
      const Vec3 middle = corner.middle_normal();
      double visibility = 1.0;
      for (std::size_t i = 0; i < n; ++i) {
        const std::vector<Vec3> normals = corner.normals_across(i);
        std::vector<VertexId>& lines = corner.lines.emplace_back();
        for (std::size_t k = 0; k < normals.size(); ++k) {
          visibility = std::min(visibility, dot(middle, normals[k]));
          lines.push_back(k == 0 ? of_side[i] : k + 1 == normals.size() ? of_side[(i + n - 1) % n] : new_line(v, false, normals[k]));
        }
        if (i > 0) move_triangles(v, sector(corner.edges[i], corner.edges[(i + 1) % n]), of_side[i]);
      }
      corner.middle = new_line(v, false, middle);
      domain_.ridges.base_vertices.push_back({v, given_[v], middle, std::max(0.0, visibility), to_end_[v]});
    }
  }

  void number_base_vertices() {
    OpenedRidges& ridges = domain_.ridges;
    std::ranges::sort(ridges.base_vertices, {}, &OpenedRidges::BaseVertex::vertex);
    ridges.base_vertex.resize(wall_.n_vertices());
    for (const VertexId v : ridges.base_vertex.ids()) ridges.base_vertex[v] = v;
    for (const std::vector<VertexId>& chain : chains_)
      for (const VertexId v : chain)
        for (const VertexId line : inner_[v]->lines) ridges.base_vertex[line] = v;
    for (const auto& [v, corner] : corners_) {
      for (const std::vector<VertexId>& lines : corner.lines)
        for (const VertexId line : lines) ridges.base_vertex[line] = v;
      ridges.base_vertex[corner.middle] = v;
    }
  }

  /// Returns true if a ridge continues at v in its mirror image.
  bool is_at_plane(VertexId v) const { return inner_[v] && (!inner_[v]->ahead.is_valid() || !inner_[v]->back.is_valid()); }

  /// Returns the growth lines of the vertex where an edge starts, from left to right of the direction along the edge.
  std::vector<VertexId> lines_along(HalfedgeId h) const {
    const VertexId v = topology_.from(h);
    if (!inner_[v]) {
      const RidgeCorner& corner = corners_.at(v);
      return corner.lines[corner.edge_number(h)];
    }
    std::vector<VertexId> lines = inner_[v]->lines;
    if (h != inner_[v]->ahead) std::ranges::reverse(lines);
    return lines;
  }

  void close_gaps() {
    OpenedRidges& ridges = domain_.ridges;
    for (const std::vector<VertexId>& chain : chains_)
      for (const VertexId v : chain)
        for (const HalfedgeId h : {inner_[v]->ahead, inner_[v]->back})
          if (h.is_valid() && !(is_inner_at(h) && topology_.to(h) < v)) close_gap(h);
    for (const auto& [v, corner] : corners_) {
      for (const HalfedgeId h : corner.edges)
        if (!is_inner_at(h) && !(has_multi_normal_at(h) && topology_.to(h) < v)) close_gap(h);
      for (std::size_t i = 0; i < corner.edges.size(); ++i)
        for (std::size_t k = 0; k + 1 < corner.lines[i].size(); ++k) {
          ridges.corners.push_back({corner.lines[i][k + 1], corner.lines[i][k], corner.middle});
          add_triangle(ridges.corners.back(), corner.edges[i], wall_.triangle_patch[triangle_of(corner.edges[i])]);
        }
    }
    std::ranges::sort(ridges.end_vertices);
    ridges.end_vertices.erase(std::unique(ridges.end_vertices.begin(), ridges.end_vertices.end()), ridges.end_vertices.end());
    if (!domain_.constraints.vertex.empty())
      for (std::size_t i = domain_.constraints.vertex.size(); i < wall_.n_vertices(); ++i)
        domain_.constraints.vertex.push_back(VertexConstraint(domain_.constraints.vertex[ridges.base_vertex[VertexId(i)]]));
    if (!domain_.constraints.near.empty())
      for (std::size_t i = domain_.constraints.near.size(); i < wall_.n_vertices(); ++i)
        domain_.constraints.near.push_back(domain_.constraints.near[ridges.base_vertex[VertexId(i)]]);
  }

  /// Adds virtual triangles along an edge of a ridge that starts at a multi-normal fan.
  void close_gap(HalfedgeId h) {
    OpenedRidges& ridges = domain_.ridges;
    const VertexId v = topology_.from(h), w = topology_.to(h);
    const std::vector<VertexId> own = lines_along(h);
    const PatchId patch = wall_.triangle_patch[triangle_of(h)];
    if (!has_multi_normal(w)) {
      for (std::size_t i = 0; i + 1 < own.size(); ++i) {
        ridges.ends.push_back({w, own[i], own[i + 1]});
        add_triangle(ridges.ends.back(), h, patch);
      }
      ridges.end_vertices.push_back(w);
      return;
    }
    std::vector<VertexId> other = lines_along(topology_.twin(h));
    std::ranges::reverse(other);
    for (std::size_t i = 0; i + 1 < own.size(); ++i) {
      add_quad({other[i], own[i], own[i + 1], other[i + 1]}, h, patch);
      const TriangleId last(wall_.n_triangles() - 1);
      if (is_at_plane(v)) domain_.border.push_back({halfedge(TriangleId(last.index() - 1), 1), patch_beyond_[v]});
      if (is_at_plane(w)) domain_.border.push_back({halfedge(last, 2), patch_beyond_[w]});
    }
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
  Topology topology_;  ///< topology of the given wall
  Column<HalfedgeId, std::uint8_t> is_chain_;
  Column<VertexId, std::uint8_t> is_partner_;
  Column<VertexId, VertexId> partner_;  ///< partner of each vertex; valid for vertices with exactly one partner
  /// Patch of the outer boundary on which the wall ends at the vertex; invalid at other vertices, and if there are several such patches.
  Column<VertexId, PatchId> patch_beyond_;
  Column<VertexId, std::optional<Inner>> inner_;
  std::map<VertexId, RidgeCorner> corners_;
  std::vector<std::vector<VertexId>> chains_;
  Column<VertexId, double> to_end_;  ///< m, distance of each vertex to the nearest end of its ridge
  Column<VertexId, Point> given_;    ///< points of the given wall
};

/// Returns the ridge base vertices of multi-normal fans at which the opened wall intersects itself, ascending.
std::vector<VertexId> crossing_multi_normals(const Domain& opened, const RunContext& context) {
  std::vector<VertexId> base_vertices;
  const auto is_multi_normal = [&](VertexId base_vertex) {
    return std::ranges::binary_search(opened.ridges.base_vertices, base_vertex, {}, &OpenedRidges::BaseVertex::vertex);
  };
  for (const auto& pair : find_crossings(opened.wall, context).pairs)
    for (const std::uint32_t t : pair)
      for (const VertexId v : opened.wall.triangles[TriangleId(t)])
        if (const VertexId base_vertex = opened.ridges.base_vertex[v]; is_multi_normal(base_vertex)) base_vertices.push_back(base_vertex);
  sort_unique(base_vertices);
  return base_vertices;
}

std::size_t count_corners(const OpenedRidges& ridges) {
  std::vector<VertexId> base_vertices;
  for (const auto& t : ridges.corners) base_vertices.push_back(ridges.base_vertex[t[0]]);
  sort_unique(base_vertices);
  return base_vertices.size();
}

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
                       "move the surface to the origin, or set open_ridges = \"never\"");
  std::vector<VertexId> shut(closed.begin(), closed.end());
  for (;;) {
    Domain opened = domain;
    RidgeOpener(options, is_open, first_height, raise, opened, context).open(shut);
    if (opened.ridges.is_empty()) return;
    const std::vector<VertexId> crossing = crossing_multi_normals(opened, context);
    if (crossing.empty()) {
      domain = std::move(opened);
      break;
    }
    context.warn("ridges stay closed at " + std::to_string(crossing.size()) +
                 " vertices of the wall: the growth lines of several normals would cross the wall, the first at " +
                 format_point(domain.wall.points[crossing.front()]));
    shut.insert(shut.end(), crossing.begin(), crossing.end());
  }
  const OpenedRidges& ridges = domain.ridges;
  const std::size_t n_corners = count_corners(ridges);
  context.info("ridges: " + std::to_string(ridges.base_vertices.size()) + " vertices of the wall have several normals, " +
               (n_corners == 0 ? "" : std::to_string(n_corners) + " of them corners, ") + std::to_string(domain.wall.n_vertices() - ridges.n_given_vertices) +
               " additional growth lines");
}

}  // namespace sterna::volmesh
