#include "volmesh/domain/trailing_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/glob.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"

namespace sterna::volmesh {
namespace {

constexpr double k_sharp_edge_turn = 120.0 * k_degree;
constexpr double k_looks_downstream = 0.342;  ///< cosine of 70 degrees: largest angle between the stream and the outward direction of the edge
constexpr double k_base_turn_from = 40.0 * k_degree, k_base_turn_to = 140.0 * k_degree;
/// Cosine between normal and stream: above the first value a triangle is part of a base, below the second part of a side.
constexpr double k_base_cosine = 0.7, k_side_of_base_cosine = 0.5;
constexpr double k_upright = 0.3;       ///< largest |z| of the normals of upright sides
constexpr double k_base_width = 0.1;    ///< largest width of a base, as a fraction of the chord
constexpr double k_chain_bend = 0.5;    ///< cosine of 60 degrees: largest bend of a chain
constexpr double k_median_reach = 0.5;  ///< chords: range to both sides over which medians are taken
constexpr std::size_t k_least_edges = 3;

Vec3 unit_normal_of(const TriMesh& wall, TriangleId t) {
  const auto [a, b, c] = corners(wall, t);
  return normalized(area_vector(a, b, c));
}

Vec3 along(const TriMesh& wall, const Topology& topology, HalfedgeId h) { return normalized(wall.points[topology.to(h)] - wall.points[topology.from(h)]); }

/// Returns 1 for each triangle of `wing`.
Column<TriangleId, std::uint8_t> marks_of(const TriMesh& wall, const WingTriangles& wing) {
  Column<PatchId, std::uint8_t> matches(wall.patches.size(), 0);
  for (const PatchId p : wall.patches.ids()) matches[p] = wall.patches[p].kind == PatchKind::wall && matches_glob(wall.patches[p].name, wing.patches) ? 1 : 0;
  Column<TriangleId, std::uint8_t> result(wall.n_triangles(), 0);
  for (const TriangleId t : wall.triangles.ids())
    if (t.index() < wing.n_triangles) result[t] = matches[wall.triangle_patch[t]];
  return result;
}

/// Returns the unit vector out of the wing, across an edge and halfway between both of its sides.
Vec3 looks_along(const TriMesh& wall, const Topology& topology, HalfedgeId edge) {
  const Vec3 e = along(wall, topology, edge);
  return normalized(cross(e, unit_normal_of(wall, triangle_of(edge))) + cross(unit_normal_of(wall, triangle_of(topology.twin(edge))), e));
}

/// Returns the turn of the wall at an edge in rad, positive where the edge is convex.
double turn_of(const TriMesh& wall, const Topology& topology, HalfedgeId h) {
  const Vec3 own = unit_normal_of(wall, triangle_of(h)), other = unit_normal_of(wall, triangle_of(topology.twin(h)));
  const double turn = std::atan2(dot(cross(own, other), along(wall, topology, h)), dot(own, other));
  const bool is_knife = turn < -k_sharp_edge_turn && dot(looks_along(wall, topology, h), own + other) >= 0.0;
  return is_knife ? -turn : turn;  // the turn is 180 degrees except for rounding, so its sign is not reliable
}

bool is_sharp(const TriMesh& wall, const Topology& topology, HalfedgeId h, const Vec3& stream) {
  return turn_of(wall, topology, h) > k_sharp_edge_turn && dot(looks_along(wall, topology, h), stream) > k_looks_downstream;
}

bool looks_up(const Vec3& normal) { return std::abs(normal.z) > k_upright ? normal.z > 0.0 : normal.y > 0.0; }

bool is_base(const Vec3& normal, const Vec3& stream) { return dot(normal, stream) > k_base_cosine; }

/// Returns true if the half-edge's own triangle belongs to the side and the triangle of its twin to the base.
bool is_above_base(const TriMesh& wall, const Topology& topology, HalfedgeId h, const Vec3& stream) {
  const Vec3 side = unit_normal_of(wall, triangle_of(h)), base = unit_normal_of(wall, triangle_of(topology.twin(h)));
  if (!is_base(base, stream) || dot(side, stream) > k_side_of_base_cosine || !looks_up(side)) return false;
  const double turn = turn_of(wall, topology, h);
  return turn > k_base_turn_from && turn < k_base_turn_to;
}

/// Calls f(point) for each point at which the plane section cuts edges, along the connected section from a vertex. \p is_part returns true if the section may
/// cross a triangle
template <class IsPart, class F>
void walk_section(const TriMesh& wall, const Topology& topology, VertexId from, const Vec3& normal, const IsPart& is_part, const F& f) {
  const Point p = wall.points[from];
  const auto side_of = [&](VertexId w) { return dot(wall.points[w] - p, normal); };
  std::vector<TriangleId> front, seen;
  const auto visit = [&](TriangleId t) {
    if (!is_part(t)) return;
    const auto at = std::ranges::lower_bound(seen, t);
    if (at != seen.end() && *at == t) return;
    seen.insert(at, t);
    front.push_back(t);
  };
  for (const HalfedgeId h : topology.outgoing(from)) visit(triangle_of(h));
  while (!front.empty()) {
    const TriangleId t = front.back();
    front.pop_back();
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(t, k);
      const VertexId a = topology.from(h), b = topology.to(h);
      const double at_a = side_of(a), at_b = side_of(b);
      if ((at_a > 0.0) == (at_b > 0.0)) continue;
      f(wall.points[a] + at_a / (at_a - at_b) * (wall.points[b] - wall.points[a]));
      if (!topology.is_boundary(h)) visit(triangle_of(topology.twin(h)));
    }
  }
}

/// Returns the normal of the section plane at a vertex inside a chain.
Vec3 section_normal(const TriMesh& wall, const Topology& topology, HalfedgeId back, HalfedgeId ahead, const Vec3& stream) {
  const Vec3 edge = normalized(along(wall, topology, ahead) + along(wall, topology, back));
  return normalized(edge - dot(edge, stream) * stream);
}

/// Returns true if the base below a chain is narrow everywhere.
bool has_narrow_base(const TriMesh& wall, const Topology& topology, const WingTriangles& wing, const Vec3& stream, const TrailingEdge& chain) {
  const std::vector<double> chords = local_chords(wall, topology, wing, stream, chain);
  for (std::size_t i = 1; i < chain.edges.size(); ++i) {
    const VertexId v = topology.from(chain.edges[i]);
    double width = 0.0;
    walk_section(
        wall, topology, v, section_normal(wall, topology, chain.edges[i - 1], chain.edges[i], stream),
        [&](TriangleId t) { return is_base(unit_normal_of(wall, t), stream); },
        [&](const Point& cut) { width = std::max(width, distance(cut, wall.points[v])); });
    if (width > k_base_width * chords[i]) return false;
  }
  return true;
}

/// Returns the weighted median.
double weighted_median(std::vector<std::array<double, 2>> values) {
  std::ranges::sort(values);
  double whole = 0.0, below = 0.0;
  for (const auto& [value, weight] : values) whole += weight;
  for (const auto& [value, weight] : values)
    if ((below += weight) >= 0.5 * whole) return value;
  return 0.0;
}

/// Replaces the values at a chain's vertices by medians over k_median_reach chords to both sides. Medians are needed because sections near a body continue over
/// the body or end at the wing's root, and sections at a tip become arbitrarily short.
std::vector<double> medians_along(const TriMesh& wall, const Topology& topology, const TrailingEdge& chain, const std::vector<double>& values) {
  const std::size_t n = values.size();
  std::vector<double> at = {0.0}, weight(n, 0.0);  // m: position along the chain, and weight
  for (std::size_t i = 0; i < chain.edges.size(); ++i) {
    const double length = distance(wall.points[topology.from(chain.edges[i])], wall.points[topology.to(chain.edges[i])]);
    at.push_back(at.back() + length);
    for (const std::size_t end : {i, i + 1}) weight[end % n] += length;
  }
  const auto median = [&](double middle, double reach) {
    std::vector<std::array<double, 2>> within;
    for (std::size_t i = 0; i < n; ++i) {
      const double way = std::abs(at[i] - middle);
      if ((chain.is_loop ? std::min(way, at.back() - way) : way) <= reach) within.push_back({values[i], weight[i]});
    }
    return weighted_median(std::move(within));
  };
  const double reach = k_median_reach * median(0.0, at.back());
  std::vector<double> medians;
  for (std::size_t i = 0; i < n; ++i) medians.push_back(median(at[i], reach));
  return medians;
}

}  // namespace

Vec3 normal_behind(const TriMesh& wall, const Topology& topology, HalfedgeId edge, bool is_blunt, const Vec3& stream) {
  if (!is_blunt) return cross(along(wall, topology, edge), looks_along(wall, topology, edge));
  const Vec3 own = unit_normal_of(wall, triangle_of(edge)), other = unit_normal_of(wall, triangle_of(topology.twin(edge)));
  return is_base(other, stream) ? -own : other;
}

std::vector<TrailingEdge> find_trailing_edges(const TriMesh& wall, const Topology& topology, const WingTriangles& wing, const Vec3& stream) {
  enum : std::uint8_t { none, sharp, blunt };
  const Column<TriangleId, std::uint8_t> is_wing = marks_of(wall, wing);
  Column<HalfedgeId, std::uint8_t> kind(topology.n_halfedges(), none);
  Column<VertexId, std::uint8_t> n_edges(wall.n_vertices(), 0);
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i), twin = topology.twin(h);
    if (!twin.is_valid() || twin < h || !is_wing[triangle_of(h)] || !is_wing[triangle_of(twin)]) continue;
    const bool is_blunt = is_above_base(wall, topology, h, stream) || is_above_base(wall, topology, twin, stream);
    if (!is_blunt && !is_sharp(wall, topology, h, stream)) continue;
    kind[h] = kind[twin] = is_blunt ? blunt : sharp;
    for (const VertexId v : {topology.from(h), topology.to(h)}) n_edges[v] = static_cast<std::uint8_t>(std::min(3, n_edges[v] + 1));
  }
  const auto next_of = [&](HalfedgeId h) {  // the next half-edge is invalid at the end of a chain
    const VertexId v = topology.to(h);
    if (n_edges[v] != 2) return HalfedgeId();
    for (const HalfedgeId other : topology.outgoing(v))
      if (kind[other] == kind[h] && other != topology.twin(h))
        return dot(along(wall, topology, h), along(wall, topology, other)) > k_chain_bend ? other : HalfedgeId();
    return HalfedgeId();
  };
  std::vector<TrailingEdge> chains;
  Column<HalfedgeId, std::uint8_t> is_done(topology.n_halfedges(), 0);
  for (const bool from_ends : {true, false})  // the chains that remain in the second pass are loops
    for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
      const HalfedgeId first(i);
      if (kind[first] == none || is_done[first] || (from_ends && next_of(topology.twin(first)).is_valid())) continue;
      TrailingEdge chain{.is_blunt = kind[first] == blunt};
      for (HalfedgeId h = first; h.is_valid() && !is_done[h]; h = next_of(h)) {
        is_done[h] = is_done[topology.twin(h)] = 1;
        chain.edges.push_back(h);
      }
      chain.is_loop = !from_ends;
      if (chain.edges.size() < k_least_edges || (chain.is_blunt && !has_narrow_base(wall, topology, wing, stream, chain))) continue;
      chains.push_back(std::move(chain));
    }
  std::ranges::sort(chains, {}, [](const TrailingEdge& chain) { return *std::ranges::min_element(chain.edges); });
  return chains;
}

std::vector<double> local_chords(const TriMesh& wall, const Topology& topology, const WingTriangles& wing, const Vec3& stream, const TrailingEdge& chain) {
  const Column<TriangleId, std::uint8_t> is_wing = marks_of(wall, wing);
  const std::size_t n = chain.edges.size(), n_vertices = chain.is_loop ? n : n + 1;
  std::vector<double> chords(n_vertices, 0.0);
  for (std::size_t i = 0; i < n_vertices; ++i) {
    if (!chain.is_loop && (i == 0 || i == n)) continue;
    const VertexId v = topology.from(chain.edges[i]);
    const Vec3 across = section_normal(wall, topology, chain.edges[(i + n - 1) % n], chain.edges[i], stream);
    walk_section(
        wall, topology, v, across, [&](TriangleId t) { return is_wing[t] != 0; },
        [&](const Point& cut) { chords[i] = std::max(chords[i], dot(wall.points[v] - cut, stream)); });
  }
  if (!chain.is_loop) {
    chords.front() = chords[1];
    chords.back() = chords[n - 1];
  }
  return medians_along(wall, topology, chain, chords);
}

}  // namespace sterna::volmesh
