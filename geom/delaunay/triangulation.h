// Connectivity of a triangulation in a parameter plane: triangles, their neighbours, constrained edges. Positions are used only to test validity; quality is
// defined by a criterion (planar.h, surface_triangulation.h).
// Invariants (check_triangulation.h): half-edge 3 * t + c runs from corner c of triangle t to corner c + 1, the triangle to its left; twins are mutual and run
// in opposite directions; a half-edge without a twin is on the border and constrained; both sides of an edge have the same constraint flag; every triangle of
// three positions turns strictly counter-clockwise by the exact predicate.
// A triangulation of the whole plane has one vertex without a position, the ghost (an invalid VertexId): each edge of the convex hull has a triangle with it. A
// triangulation of a carved domain has no ghost.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/halfedge.h"
#include "geom/base/ids.h"
#include "geom/math/predicates.h"

namespace sterna::delaunay {

inline constexpr VertexId k_ghost{};

/// Kinds of an edge, combinable.
using EdgeFlags = std::uint8_t;
inline constexpr EdgeFlags k_free_edge = 0;
inline constexpr EdgeFlags k_constrained = 1;    ///< never flipped, never in a cavity
inline constexpr EdgeFlags k_domain_border = 2;  ///< boundary of the domain (only together with k_constrained)

/// One triangle, 32 bytes: two per cache line.
struct Cell {
  std::array<VertexId, 3> vertex;
  std::array<HalfedgeId, 3> twin;
  std::array<EdgeFlags, 3> flags{};
  bool is_dead = false;     ///< in the list of free slots
  std::uint32_t stamp = 0;  ///< changes whenever the slot is reused for another triangle
};

struct Triangulation {
  Column<TriangleId, Cell> cells;
  Column<VertexId, Vec2> uv;              ///< positions; undefined for the ghost
  Column<VertexId, HalfedgeId> outgoing;  ///< one half-edge from each vertex; invalid: not in the triangulation
  std::vector<TriangleId> free_cells;

  VertexId origin(HalfedgeId h) const { return cells[triangle_of(h)].vertex[corner_of(h)]; }
  VertexId target(HalfedgeId h) const { return origin(next(h)); }
  VertexId apex(HalfedgeId h) const { return origin(previous(h)); }
  HalfedgeId twin(HalfedgeId h) const { return cells[triangle_of(h)].twin[corner_of(h)]; }
  EdgeFlags flags(HalfedgeId h) const { return cells[triangle_of(h)].flags[corner_of(h)]; }
  bool is_constrained(HalfedgeId h) const { return (flags(h) & k_constrained) != 0; }
  bool is_ghost(TriangleId t) const {
    const auto& v = cells[t].vertex;
    return !v[0].is_valid() || !v[1].is_valid() || !v[2].is_valid();
  }

  void set_twin(HalfedgeId h, HalfedgeId twin) { cells[triangle_of(h)].twin[corner_of(h)] = twin; }
  /// Sets the kind of an edge on both sides.
  void set_flags(HalfedgeId h, EdgeFlags flags);

  /// Returns +1 if a, b, c turn counter-clockwise.
  /// \pre none is the ghost
  int turn(VertexId a, VertexId b, VertexId c) const { return orient2d(uv[a], uv[b], uv[c]); }

  /// Returns a slot for a triangle, to be filled by the caller.
  TriangleId new_cell();
  void free_cell(TriangleId t);
  std::size_t n_triangles() const { return cells.size() - free_cells.size(); }
};

/// Returns true if the edge may be replaced by the other diagonal: free, two real triangles, both new ones strictly counter-clockwise.
bool is_flip_valid(const Triangulation& mesh, HalfedgeId h);
/// Replaces an edge by the other diagonal; afterwards `h` is the new edge, from the apex of its twin's triangle to its own former apex.
/// \pre is_flip_valid
void flip(Triangulation& mesh, HalfedgeId h);

/// Returns the half-edge from a to b, or an invalid one; rotates around a, whichever side the border is on.
/// \pre the star of a is one fan
HalfedgeId find_edge(const Triangulation& mesh, VertexId a, VertexId b);

/// Calls f(half-edge from v) for every triangle at v, counter-clockwise; once around, or from border to border.
/// \pre the star is one fan
template <class F>
void for_star(const Triangulation& mesh, VertexId v, const F& f) {
  const HalfedgeId first = mesh.outgoing[v];
  HalfedgeId start = first;
  // Rotate to the clockwise end of an open fan.
  for (HalfedgeId h = mesh.twin(start); h.is_valid();) {
    start = next(h);
    if (start == first) break;
    h = mesh.twin(start);
  }
  HalfedgeId h = start;
  do {
    f(h);
    h = mesh.twin(previous(h));
  } while (h.is_valid() && h != start);
}

}  // namespace sterna::delaunay
