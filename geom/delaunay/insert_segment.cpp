// Inserts segments as edges. Based on: S. W. Sloan, "A fast algorithm for generating constrained Delaunay triangulations", Computers & Structures 47 (1993).
//
// The segment is followed from its start. Where it runs along an edge or through a vertex, that piece is done (follow_to_vertex). Otherwise the edges it
// crosses are flipped, in turn, until none crosses (flip_crossing_edges); then the new edges are flipped to the empty circle (restore_delaunay). All decisions
// are exact.
#include <algorithm>
#include <deque>
#include <vector>

#include "geom/base/error.h"
#include "geom/delaunay/planar.h"

namespace sterna::delaunay {
namespace {

struct Edge {
  VertexId a, b;
};

/// A multiple of the square of the number of crossed edges that Sloan's queue stays far below; exceeding it indicates an error in this file.
constexpr std::size_t k_flip_limit_factor = 64;

[[noreturn]] void throw_crossing(const Triangulation& mesh, VertexId a, VertexId b, HalfedgeId h) {
  const VertexId c = mesh.origin(h), d = mesh.target(h);
  const Vec2 &pa = mesh.uv[a], &pb = mesh.uv[b], &pc = mesh.uv[c], &pd = mesh.uv[d];
  const double across_c = (pb.x - pa.x) * (pc.y - pa.y) - (pb.y - pa.y) * (pc.x - pa.x);
  const double across_d = (pb.x - pa.x) * (pd.y - pa.y) - (pb.y - pa.y) * (pd.x - pa.x);
  const double s = across_c / (across_c - across_d);
  const auto at = [](const Vec2& p) { return Vec3{p.x, p.y, 0.0}; };
  const Vec3 location = at(pc) + s * (at(pd) - at(pc));
  ErrorInfo info{.code = ErrorCode::self_intersection,
                 .attempted = "triangulating points and segments in the plane",
                 .problem = "two segments cross: between points " + std::to_string(a.value()) + " and " + std::to_string(b.value()) + ", and between points " +
                            std::to_string(c.value()) + " and " + std::to_string(d.value())};
  info.locations.push_back({location, "crossing of the segments " + format_point(at(pa)) + " - " + format_point(at(pb)) + " and " + format_point(at(pc)) +
                                          " - " + format_point(at(pd))});
  info.hint = "borders may touch only at common points";
  info.geometry.points = {at(pa), at(pb), at(pc), at(pd), location};
  info.geometry.edges = {{0, 1}, {2, 3}};
  info.geometry.vertices = {4};
  throw Error(std::move(info));
}

bool is_ahead(const Vec2& from, const Vec2& to, const Vec2& p) {
  // The point is on the line from -> to, so one coordinate in which the ends differ decides exactly.
  if (from.x != to.x) return from.x < to.x ? p.x > from.x : p.x < from.x;
  return from.y < to.y ? p.y > from.y : p.y < from.y;
}

/// Start of the path from a towards b: either the edge along which it begins (`along`), or the half-edge opposite to a that it crosses first.
struct Departure {
  HalfedgeId along;
  HalfedgeId crossed;
};

Departure depart(const Triangulation& mesh, VertexId a, VertexId b) {
  const Vec2 &pa = mesh.uv[a], &pb = mesh.uv[b];
  Departure departure;
  const HalfedgeId first = mesh.outgoing[a];
  HalfedgeId h = first;
  do {
    const VertexId right = mesh.target(h), left = mesh.apex(h);
    if (right.is_valid()) {
      const int side = orient2d(pa, pb, mesh.uv[right]);
      if (side == 0 && is_ahead(pa, pb, mesh.uv[right])) return {h, {}};
      // A corner is less than half a turn, so the forward direction lies between its two sides, not the backward one.
      if (side < 0 && left.is_valid() && orient2d(pa, pb, mesh.uv[left]) > 0) departure.crossed = next(h);
    }
    h = mesh.twin(previous(h));
  } while (h != first);
  return departure;
}

/// Collects the edges that the segment crosses from `crossed` on, up to the first vertex on it; returns that vertex.
VertexId collect_crossed(const Triangulation& mesh, VertexId a, VertexId b, HalfedgeId crossed, std::deque<Edge>& edges) {
  // `crossed` runs from the right of the segment to its left, seen from a; the segment leaves its triangle there.
  for (HalfedgeId h = crossed;;) {
    if (mesh.is_constrained(h)) throw_crossing(mesh, a, b, h);
    edges.push_back({mesh.origin(h), mesh.target(h)});
    const HalfedgeId g = mesh.twin(h);
    const VertexId apex = mesh.apex(g);
    const int side = mesh.turn(a, b, apex);
    if (side == 0) return apex;
    // g runs from the left to the right: next(g) joins the right vertex with the apex, previous(g) the apex with the left one.
    h = side > 0 ? next(g) : previous(g);
  }
}

/// Flips until no edge crosses the segment from a to b. New edges that do not cross are added to `fresh`.
void flip_crossing_edges(Triangulation& mesh, VertexId a, VertexId b, std::deque<Edge>& crossing, std::vector<Edge>& fresh) {
  std::size_t allowed = k_flip_limit_factor * (crossing.size() + 1) * (crossing.size() + 1);
  while (!crossing.empty()) {
    if (allowed-- == 0)
      throw Error({.code = ErrorCode::internal,
                   .attempted = "inserting a segment into a triangulation",
                   .problem = "flipping the edges that cross the segment did not end"});
    const Edge edge = crossing.front();
    crossing.pop_front();
    const HalfedgeId h = find_edge(mesh, edge.a, edge.b);
    if (!is_flip_valid(mesh, h)) {
      crossing.push_back(edge);
      continue;
    }
    flip(mesh, h);
    const Edge other{mesh.origin(h), mesh.target(h)};
    const bool shares_end = other.a == a || other.a == b || other.b == a || other.b == b;
    const bool crosses = !shares_end && mesh.turn(a, b, other.a) * mesh.turn(a, b, other.b) < 0;
    if (crosses) crossing.push_back(other);
    else fresh.push_back(other);
  }
}

/// Flips the edges of `edges`, and affected neighbours, to the empty circle. Every flip lowers the surface lifted to the paraboloid, so it terminates.
void restore_delaunay(Triangulation& mesh, std::vector<Edge>& edges) {
  while (!edges.empty()) {
    const Edge edge = edges.back();
    edges.pop_back();
    const HalfedgeId h = find_edge(mesh, edge.a, edge.b);
    if (!h.is_valid() || !is_flip_valid(mesh, h)) continue;
    const VertexId c = mesh.apex(h), d = mesh.apex(mesh.twin(h));
    if (incircle(mesh.uv[edge.a], mesh.uv[edge.b], mesh.uv[c], mesh.uv[d]) <= 0) continue;
    flip(mesh, h);
    for (const Edge side : {Edge{edge.a, c}, Edge{c, edge.b}, Edge{edge.b, d}, Edge{d, edge.a}}) edges.push_back(side);
  }
}

}  // namespace

void insert_segment(Triangulation& mesh, VertexId a, VertexId b, bool is_border) {
  std::deque<Edge> crossing;
  std::vector<Edge> fresh;
  while (a != b) {
    const Departure departure = depart(mesh, a, b);
    HalfedgeId h = departure.along;
    VertexId end;
    if (h.is_valid()) {
      end = mesh.target(h);
    } else {
      end = collect_crossed(mesh, a, b, departure.crossed, crossing);
      flip_crossing_edges(mesh, a, end, crossing, fresh);
      h = find_edge(mesh, a, end);
    }
    // Where borders overlap, the domain changes sides once per border.
    const EdgeFlags border = is_border ? k_domain_border : k_free_edge;
    mesh.set_flags(h, static_cast<EdgeFlags>((mesh.flags(h) | k_constrained) ^ border));
    restore_delaunay(mesh, fresh);
    a = end;
  }
}

}  // namespace sterna::delaunay
