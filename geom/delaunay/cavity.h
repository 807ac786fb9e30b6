// Insertion of one vertex (Bowyer 1981, Watson 1981) and the walk that locates it. Based on: Devillers, Pion, Teillaud, "Walking in a triangulation", 2002.
// The cavity grows from the triangle that contains the point, across free edges, depth first. A neighbour joins if it is in conflict with the vertex by the
// criterion and its other two edges are visible from the vertex from inside, by the exact predicate. By induction the cavity is therefore star-shaped from the
// vertex at every step, whatever the criterion: no vertex is enclosed, no triangle is inverted, no triangle is visited twice (no marks are needed). For the
// exact criterion of the plane the second condition only stops at triangles that are not visible behind constrained edges. Because the search is depth first in
// the sense of rotation, the border of the cavity is obtained in order, so the new triangles can be linked one after the other.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/delaunay/triangulation.h"

namespace sterna::delaunay {

struct Location {
  enum class Kind {
    inside,         ///< inside the triangle of `halfedge`
    on_edge,        ///< in the interior of `halfedge`
    on_vertex,      ///< at the origin of `halfedge`
    outside,        ///< beyond the hull: `halfedge` belongs to a ghost triangle in conflict
    beyond_border,  ///< the walk ended at the border half-edge `halfedge` of a carved domain
    lost,           ///< the limit of steps was reached (triangulations that are not Delaunay in the plane)
  };
  Kind kind = Kind::lost;
  HalfedgeId halfedge;
};

/// Walks from triangle `from` (not dead) towards `plane_point`, over at most `max_steps` triangles.
Location locate(const Triangulation& mesh, const Vec2& plane_point, TriangleId from, std::size_t max_steps);

/// Work arrays of insertions; keep one object for many insertions, so that none of them allocates.
struct Cavity {
  struct BorderEdge {
    HalfedgeId outer;   ///< the half-edge outside, invalid on the domain's border
    VertexId from, to;  ///< counter-clockwise around the cavity
    EdgeFlags flags;
  };
  std::vector<TriangleId> triangles;
  std::vector<BorderEdge> border;  ///< in order
  bool is_open = false;            ///< the vertex is on the domain's border: no triangle closes the fan
  std::vector<HalfedgeId> stack;
};

/// Collects the cavity of vertex `p` at `location` (inside, on_edge or outside). A Criterion has the function bool conflicts(mesh, triangle, p), called for
/// real triangles only.
/// \post the cavity is strictly star-shaped from p; for an edge, both of its triangles belong to it
template <class Criterion>
void grow_cavity(const Triangulation& mesh, VertexId p, const Location& location, const Criterion& criterion, Cavity& cavity) {
  cavity.triangles.clear();
  cavity.border.clear();
  cavity.stack.clear();
  cavity.is_open = false;
  const HalfedgeId seed = location.halfedge;
  const HalfedgeId forced = location.kind == Location::Kind::on_edge ? seed : HalfedgeId{};
  cavity.triangles.push_back(triangle_of(seed));
  // The seed edge is processed last, so that an open fan begins and ends there.
  cavity.stack.push_back(seed);
  cavity.stack.push_back(previous(seed));
  cavity.stack.push_back(next(seed));
  const auto sees = [&](VertexId from, VertexId to) { return !from.is_valid() || !to.is_valid() || mesh.turn(from, to, p) > 0; };
  while (!cavity.stack.empty()) {
    const HalfedgeId h = cavity.stack.back();
    cavity.stack.pop_back();
    const Cell& cell = mesh.cells[triangle_of(h)];
    const std::uint32_t corner = corner_of(h);
    const HalfedgeId out = cell.twin[corner];
    const VertexId from = cell.vertex[corner], to = cell.vertex[corner == 2 ? 0 : corner + 1];
    if (h == forced && !out.is_valid()) {
      cavity.is_open = true;
      continue;
    }
    if (h == forced || (cell.flags[corner] & k_constrained) == 0) {
      const TriangleId t = triangle_of(out);
      const VertexId apex = mesh.apex(out);
      const bool joins = h == forced || (criterion.conflicts(mesh, t, p) && sees(from, apex) && sees(apex, to));
      if (joins) {
        cavity.triangles.push_back(t);
        cavity.stack.push_back(previous(out));
        cavity.stack.push_back(next(out));
        continue;
      }
    }
    cavity.border.push_back({out, from, to, cell.flags[corner]});
  }
}

/// Replaces the cavity by the fan of p. Half-edge 3 t + 2 of each new triangle starts at p; mesh.outgoing[p] is one of them.
/// If p lies on a constrained edge, the caller must mark both halves (split_flags of insert).
void fill_cavity(Triangulation& mesh, VertexId p, Cavity& cavity);

/// Inserts vertex p (its position is in mesh.uv) at `location` (inside, on_edge or outside): both halves of a split edge get the edge's kind.
template <class Criterion>
void insert(Triangulation& mesh, VertexId p, const Location& location, const Criterion& criterion, Cavity& cavity) {
  EdgeFlags flags = k_free_edge;
  VertexId a, b;
  if (location.kind == Location::Kind::on_edge) {
    flags = mesh.flags(location.halfedge);
    a = mesh.origin(location.halfedge);
    b = mesh.target(location.halfedge);
  }
  grow_cavity(mesh, p, location, criterion, cavity);
  fill_cavity(mesh, p, cavity);
  if (flags == k_free_edge) return;
  const HalfedgeId start = mesh.outgoing[p];
  HalfedgeId h = start;
  do {
    if (mesh.target(h) == a || mesh.target(h) == b) mesh.set_flags(h, flags);
    const HalfedgeId in = previous(h);
    if (mesh.origin(in) == a || mesh.origin(in) == b) mesh.set_flags(in, flags);
    h = mesh.twin(in);
  } while (h.is_valid() && h != start);
}

}  // namespace sterna::delaunay
