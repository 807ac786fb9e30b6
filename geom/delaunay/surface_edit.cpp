// Individual changes of a surface triangulation: flips to the criterion, moves, collapses. Each verifies validity in the plane before it changes anything.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geom/delaunay/surface_triangulation.h"

namespace sterna::delaunay {
namespace {

/// Limit of the sum of the cotangents of the angles opposite to an edge above which the edge stays: 0 is exactly pi; rounding must not cause flips back and
/// forth.
constexpr double k_flip_margin = -1e-9;
/// Minimum relative decrease of the worst cotangent.
constexpr double k_min_flip_gain = 1e-9;

struct Quad {
  VertexId a, b;  ///< the edge
  VertexId c, d;  ///< vertices to its left and right
};

/// Returns the smallest cosine between the triangle's normal and the surface's normals at its corners; corners without a normal are ignored.
double normal_cosine(const SurfaceTriangulation& surface, VertexId a, VertexId b, VertexId c) {
  const Vec3 normal = cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a]);
  double least = 1.0;
  const double length = norm(normal);
  for (const VertexId v : {a, b, c}) {
    const Vec3& along = surface.frames[v].normal;
    if (norm2(along) > 0.0) least = std::min(least, length > 0.0 ? dot(normal, along) / length : -1.0);
  }
  return least;
}

bool needs_flip(const SurfaceTriangulation& surface, const Quad& q) {
  const Point &a = surface.points[q.a], &b = surface.points[q.b], &c = surface.points[q.c], &d = surface.points[q.d];
  const Vec3 ca = a - c, cb = b - c, da = a - d, db = b - d;
  const double area_c = norm(cross(ca, cb)), area_d = norm(cross(da, db));
  // cot(c) + cot(d) < 0, without division.
  if (dot(ca, cb) * area_d + dot(da, db) * area_c >= k_flip_margin * area_c * area_d) return false;
  const double before = std::max(worst_cotangent(a, b, c), worst_cotangent(b, a, d));
  const double after = std::max(worst_cotangent(a, d, c), worst_cotangent(d, b, c));
  if (!(after < (1.0 - k_min_flip_gain) * before)) return false;
  const double cosine_after = std::min(normal_cosine(surface, q.a, q.d, q.c), normal_cosine(surface, q.d, q.b, q.c));
  if (cosine_after >= k_min_normal_cosine) return true;
  return cosine_after > std::min(normal_cosine(surface, q.a, q.b, q.c), normal_cosine(surface, q.b, q.a, q.d));
}

void note_quad(const Triangulation& mesh, HalfedgeId h, std::vector<HalfedgeId>& changed) {
  const HalfedgeId g = mesh.twin(h);
  for (const HalfedgeId side : {next(h), previous(h), next(g), previous(g)}) changed.push_back(side);
}

/// The edge between inner vertex w and a pole, with the flat triangles between w and the pole's vertices.
struct PoleEdge {
  VertexId w;
  std::vector<VertexId> poles;  ///< counter-clockwise around w, at least two
  VertexId right, left;         ///< apexes of the triangles beside the edge that are not flat
};

/// Finds the pole edge. \pre the triangle of h is flat. Returns false if the flat triangles reach the border or go all around.
bool find_pole_edge(const SurfaceTriangulation& surface, HalfedgeId h, PoleEdge& edge) {
  const Triangulation& mesh = surface.mesh;
  const auto& v = mesh.cells[triangle_of(h)].vertex;
  // The corner that does not belong to the pole.
  const std::uint32_t c = surface.stands_for[v[0]] == surface.stands_for[v[1]] ? 2u : surface.stands_for[v[1]] == surface.stands_for[v[2]] ? 0u : 1u;
  edge.w = v[c];
  const VertexId pole = surface.stands_for[v[(c + 1) % 3]];
  if (surface.stands_for[edge.w] == pole) return false;
  const auto is_fan = [&](HalfedgeId out) { return surface.stands_for[mesh.target(out)] == pole && surface.stands_for[mesh.apex(out)] == pole; };
  const HalfedgeId start = halfedge(triangle_of(h), c);
  HalfedgeId first = start;
  for (;;) {
    const HalfedgeId twin = mesh.twin(first);
    if (!twin.is_valid() || mesh.is_constrained(first)) return false;
    const HalfedgeId before = next(twin);
    if (!is_fan(before)) {
      edge.right = mesh.target(before);
      break;
    }
    first = before;
    if (first == start) return false;
  }
  edge.poles.clear();
  HalfedgeId out = first;
  for (; is_fan(out);) {
    edge.poles.push_back(mesh.target(out));
    const HalfedgeId in = previous(out);
    if (!mesh.twin(in).is_valid() || mesh.is_constrained(in)) return false;
    out = mesh.twin(in);
  }
  edge.poles.push_back(mesh.target(out));
  edge.left = mesh.apex(out);
  return true;
}

/// Flips the edges from w to the poles in the given order; all or none.
bool flip_in_turn(Triangulation& mesh, VertexId w, const std::vector<VertexId>& poles, std::vector<HalfedgeId>& changed) {
  const std::size_t n_before = changed.size();
  std::vector<std::array<VertexId, 2>> done;  // a flip moves the sides of its quad to other half-edges, so edges are identified by their ends
  for (const VertexId pole : poles) {
    const HalfedgeId h = find_edge(mesh, w, pole);
    if (!h.is_valid() || !is_flip_valid(mesh, h)) {
      for (; !done.empty(); done.pop_back()) flip(mesh, find_edge(mesh, done.back()[0], done.back()[1]));
      changed.resize(n_before);
      return false;
    }
    flip(mesh, h);
    done.push_back({mesh.origin(h), mesh.target(h)});
    note_quad(mesh, h, changed);
  }
  return true;
}

/// Flips all edges from w to the pole's vertices, which are one edge in space. Before that, moves the flat triangles to the apex on one side.
bool flip_pole_edge(SurfaceTriangulation& surface, HalfedgeId flat, std::vector<HalfedgeId>& changed) {
  PoleEdge edge;
  if (!find_pole_edge(surface, flat, edge)) return false;
  const VertexId pole = surface.stands_for[edge.poles.front()];
  if (edge.right == edge.left || surface.stands_for[edge.right] == pole || surface.stands_for[edge.left] == pole) return false;
  if (!needs_flip(surface, {edge.w, pole, edge.left, edge.right})) return false;
  if (flip_in_turn(surface.mesh, edge.w, edge.poles, changed)) return true;
  std::reverse(edge.poles.begin(), edge.poles.end());
  return flip_in_turn(surface.mesh, edge.w, edge.poles, changed);
}

void join(Triangulation& mesh, HalfedgeId h) {
  const HalfedgeId g = mesh.twin(h);
  const VertexId a = mesh.origin(h), b = mesh.target(h);
  std::vector<HalfedgeId> star;
  for_star(mesh, a, [&](HalfedgeId out) { star.push_back(out); });
  for (const HalfedgeId out : star) {
    mesh.cells[triangle_of(out)].vertex[corner_of(out)] = b;
    ++mesh.cells[triangle_of(out)].stamp;
  }
  // Each of the two triangles at the edge disappears, and its outer sides become neighbours. `kept` was the side that did not touch a.
  const auto close = [&](HalfedgeId kept, HalfedgeId moved, VertexId apex) {
    const HalfedgeId outer_kept = mesh.twin(kept), outer_moved = mesh.twin(moved);
    const EdgeFlags flags = mesh.flags(kept);
    mesh.set_twin(outer_moved, outer_kept);
    if (outer_kept.is_valid()) mesh.set_twin(outer_kept, outer_moved);
    mesh.set_flags(outer_moved, flags);
    const HalfedgeId from_b = mesh.origin(outer_moved) == b ? outer_moved : next(outer_moved);
    mesh.outgoing[b] = mesh.origin(from_b) == b ? from_b : mesh.outgoing[b];
    mesh.outgoing[apex] = mesh.origin(outer_moved) == apex ? outer_moved : next(outer_moved);
  };
  close(next(h), previous(h), mesh.apex(h));
  close(previous(g), next(g), mesh.apex(g));
  mesh.outgoing[a] = HalfedgeId{};
  mesh.free_cell(triangle_of(h));
  mesh.free_cell(triangle_of(g));
}

}  // namespace

double worst_cotangent(const Point& a, const Point& b, const Point& c) {
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const double area = norm(cross(ab, ca));
  if (area == 0.0) return std::numeric_limits<double>::infinity();
  return std::max({-dot(ab, ca), -dot(bc, ab), -dot(ca, bc)}) / area;
}

bool flip_to_criterion(SurfaceTriangulation& surface, HalfedgeId h, std::vector<HalfedgeId>& changed) {
  Triangulation& mesh = surface.mesh;
  const HalfedgeId g = mesh.twin(h);
  if (!g.is_valid() || mesh.is_constrained(h)) return false;
  if (surface.is_flat(triangle_of(h))) return flip_pole_edge(surface, h, changed);
  if (surface.is_flat(triangle_of(g))) return flip_pole_edge(surface, g, changed);
  const Quad quad{mesh.origin(h), mesh.target(h), mesh.apex(h), mesh.apex(g)};
  if (surface.stands_for[quad.c] == surface.stands_for[quad.d] || !needs_flip(surface, quad) || !is_flip_valid(mesh, h)) return false;
  flip(mesh, h);
  note_quad(mesh, h, changed);
  return true;
}

std::size_t flip_around(SurfaceTriangulation& surface, std::vector<HalfedgeId>& halfedges, std::vector<TriangleId>& touched) {
  std::size_t n = 0;
  while (!halfedges.empty()) {
    const HalfedgeId h = halfedges.back();
    halfedges.pop_back();
    const std::size_t n_left = halfedges.size();
    if (!flip_to_criterion(surface, h, halfedges)) continue;
    ++n;
    for (std::size_t i = n_left; i < halfedges.size(); ++i) touched.push_back(triangle_of(halfedges[i]));
  }
  return n;
}

std::size_t flip_all(SurfaceTriangulation& surface) {
  std::vector<HalfedgeId> halfedges;
  for (const TriangleId t : surface.mesh.cells.ids()) {
    if (surface.mesh.cells[t].is_dead) continue;
    for (std::uint32_t c = 0; c < 3; ++c) {
      const HalfedgeId h = halfedge(t, c), g = surface.mesh.twin(h);
      if (g.is_valid() && h < g) halfedges.push_back(h);
    }
  }
  std::vector<TriangleId> touched;
  return flip_around(surface, halfedges, touched);
}

bool move_vertex(SurfaceTriangulation& surface, VertexId v, Uv to, const SurfaceSample& sample) {
  Triangulation& mesh = surface.mesh;
  const Vec2 plane_point = surface.plane_point(to);
  bool is_valid = true;
  for_star(mesh, v, [&](HalfedgeId h) { is_valid = is_valid && orient2d(plane_point, mesh.uv[mesh.target(h)], mesh.uv[mesh.apex(h)]) > 0; });
  if (!is_valid) return false;
  mesh.uv[v] = plane_point;
  surface.points[v] = sample.point;
  surface.frames[v] = sample.frame;
  return true;
}

double worst_after_collapse(const SurfaceTriangulation& surface, HalfedgeId h) {
  const Triangulation& mesh = surface.mesh;
  const VertexId a = mesh.origin(h), b = mesh.target(h);
  double worst = 0.0;
  bool is_allowed = true;
  for_star(mesh, a, [&](HalfedgeId out) {
    if (!is_allowed) return;
    const VertexId x = mesh.target(out), y = mesh.apex(out);
    if (mesh.is_constrained(out)) is_allowed = false;
    if (!is_allowed || x == b || y == b) return;
    is_allowed = mesh.turn(b, x, y) > 0;
    // Beside a pole, flat triangles are ignored, both before and after the edit.
    if (surface.stands_for[b] == surface.stands_for[x] || surface.stands_for[x] == surface.stands_for[y] || surface.stands_for[y] == surface.stands_for[b])
      return;
    is_allowed = is_allowed && normal_cosine(surface, b, x, y) >= k_min_normal_cosine;
    worst = std::max(worst, worst_cotangent(surface.points[b], surface.points[x], surface.points[y]));
  });
  return is_allowed ? worst : std::numeric_limits<double>::infinity();
}

bool collapse_edge(SurfaceTriangulation& surface, HalfedgeId h, double worst_allowed) {
  if (surface.is_border(surface.mesh.origin(h))) return false;
  const double worst = worst_after_collapse(surface, h);
  if (!std::isfinite(worst) || worst > worst_allowed) return false;
  join(surface.mesh, h);
  return true;
}

}  // namespace sterna::delaunay
