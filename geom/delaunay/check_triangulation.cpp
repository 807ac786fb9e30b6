#include "geom/delaunay/check_triangulation.h"

#include <utility>
#include <vector>

namespace sterna::delaunay {
namespace {

bool is_twin_good(const Triangulation& mesh, HalfedgeId h) {
  const HalfedgeId g = mesh.twin(h);
  if (g.value() >= 3 * mesh.cells.size() || mesh.cells[triangle_of(g)].is_dead) return false;
  return mesh.twin(g) == h && mesh.origin(g) == mesh.target(h) && mesh.target(g) == mesh.origin(h);
}

/// Returns true for a half-edge of a real triangle without a real triangle on the other side.
bool is_border(const Triangulation& mesh, HalfedgeId h) {
  const HalfedgeId g = mesh.twin(h);
  return !g.is_valid() || mesh.is_ghost(triangle_of(g));
}

/// Returns the border half-edge that follows h: around its target, clockwise through the domain.
HalfedgeId next_on_border(const Triangulation& mesh, HalfedgeId h) {
  HalfedgeId g = next(h);
  while (!is_border(mesh, g)) g = next(mesh.twin(g));
  return g;
}

std::int64_t count_border_loops(const Triangulation& mesh) {
  std::vector<bool> is_seen(3 * mesh.cells.size(), false);
  std::int64_t n = 0;
  for (const TriangleId t : mesh.cells.ids()) {
    if (mesh.cells[t].is_dead || mesh.is_ghost(t)) continue;
    for (std::uint32_t c = 0; c < 3; ++c) {
      HalfedgeId h = halfedge(t, c);
      if (is_seen[h.index()] || !is_border(mesh, h)) continue;
      ++n;
      while (!is_seen[h.index()]) {
        is_seen[h.index()] = true;
        h = next_on_border(mesh, h);
      }
    }
  }
  return n;
}

}  // namespace

TriangulationCheck check_triangulation(const Triangulation& mesh) {
  TriangulationCheck check;
  std::vector<bool> is_used(mesh.uv.size(), false);
  std::int64_t n_sides = 0;
  for (const TriangleId t : mesh.cells.ids()) {
    const Cell& cell = mesh.cells[t];
    if (cell.is_dead) continue;
    const bool is_ghost = mesh.is_ghost(t);
    ++(is_ghost ? check.n_ghosts : check.n_triangles);
    if (!is_ghost && mesh.turn(cell.vertex[0], cell.vertex[1], cell.vertex[2]) <= 0) ++check.n_inverted;
    for (std::uint32_t c = 0; c < 3; ++c) {
      const HalfedgeId h = halfedge(t, c), g = cell.twin[c];
      if (g.is_valid() && !is_twin_good(mesh, h)) {
        ++check.n_bad_twins;
        continue;
      }
      if (g.is_valid() ? cell.flags[c] != mesh.flags(g) : (cell.flags[c] & k_constrained) == 0) ++check.n_bad_flags;
      if (is_ghost) continue;
      is_used[cell.vertex[c].index()] = true;
      ++n_sides;
      const bool is_border_side = is_border(mesh, h);
      if (is_border_side) ++check.n_border_edges;
      if ((cell.flags[c] & k_constrained) != 0 && (is_border_side || h < g)) ++check.n_constrained;
      if (is_border_side || h > g || (cell.flags[c] & k_constrained) != 0) continue;
      if (incircle(mesh.uv[cell.vertex[0]], mesh.uv[cell.vertex[1]], mesh.uv[cell.vertex[2]], mesh.uv[mesh.apex(g)]) > 0) ++check.n_not_delaunay;
    }
  }
  check.n_edges = (n_sides + check.n_border_edges) / 2;
  for (const VertexId v : mesh.uv.ids()) {
    if (is_used[v.index()]) ++check.n_used_vertices;
    const HalfedgeId h = mesh.outgoing[v];
    const bool is_good = h.is_valid() ? h.value() < 3 * mesh.cells.size() && !mesh.cells[triangle_of(h)].is_dead && mesh.origin(h) == v : !is_used[v.index()];
    if (!is_good) ++check.n_bad_outgoing;
  }
  // The loops can be traversed only if all twins are valid.
  if (check.n_bad_twins == 0) check.n_border_loops = count_border_loops(mesh);
  return check;
}

std::string TriangulationCheck::text() const {
  std::string text = std::to_string(n_triangles) + " triangles";
  const std::pair<std::int64_t, const char*> counts[] = {{n_inverted, "inverted"},
                                                         {n_bad_twins, "sides with a wrong neighbour"},
                                                         {n_bad_flags, "sides with a wrong constraint"},
                                                         {n_bad_outgoing, "vertices with a wrong half-edge"},
                                                         {n_not_delaunay, "edges that are not Delaunay"}};
  for (const auto& [count, what] : counts)
    if (count != 0) text += ", " + std::to_string(count) + " " + what;
  return text;
}

}  // namespace sterna::delaunay
