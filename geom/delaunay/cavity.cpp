#include "geom/delaunay/cavity.h"

namespace sterna::delaunay {
namespace {

using Kind = Location::Kind;

/// Returns the edge of the hull: the half-edge of ghost triangle t between its two real vertices.
HalfedgeId hull_edge(const Triangulation& mesh, TriangleId t) {
  const auto& v = mesh.cells[t].vertex;
  return halfedge(t, !v[0].is_valid() ? 1u : !v[1].is_valid() ? 2u : 0u);
}

/// Returns the location of a point that is to the left of or on all three edges; `zero` has a bit for each edge that it is on.
Location settle(TriangleId t, unsigned zero) {
  switch (zero) {
    case 0: return {Kind::inside, halfedge(t, 0)};
    case 1: return {Kind::on_edge, halfedge(t, 0)};
    case 2: return {Kind::on_edge, halfedge(t, 1)};
    case 4: return {Kind::on_edge, halfedge(t, 2)};
    case 3: return {Kind::on_vertex, halfedge(t, 1)};
    case 6: return {Kind::on_vertex, halfedge(t, 2)};
    default: return {Kind::on_vertex, halfedge(t, 0)};
  }
}

}  // namespace

Location locate(const Triangulation& mesh, const Vec2& plane_point, TriangleId from, std::size_t max_steps) {
  TriangleId t = from;
  HalfedgeId entered;
  if (mesh.is_ghost(t)) {
    entered = mesh.twin(hull_edge(mesh, t));
    t = triangle_of(entered);
    entered = {};
  }
  std::uint32_t first = 0;
  for (std::size_t step = 0; step < max_steps; ++step) {
    const Cell& cell = mesh.cells[t];
    unsigned zero = 0;
    HalfedgeId crossed, border;
    // The first edge tested changes from step to step: a walk that always starts with the same edge may cycle if the triangulation is not Delaunay.
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t c = (first + k) % 3;
      const HalfedgeId h = halfedge(t, c);
      if (h == entered) continue;
      const int side = orient2d(mesh.uv[cell.vertex[c]], mesh.uv[cell.vertex[c == 2 ? 0 : c + 1]], plane_point);
      if (side < 0) {
        if (cell.twin[c].is_valid()) {
          crossed = h;
          break;
        }
        border = h;
      } else if (side == 0) {
        zero |= 1u << c;
      }
    }
    if (!crossed.is_valid()) return border.is_valid() ? Location{Kind::beyond_border, border} : settle(t, zero);
    entered = mesh.twin(crossed);
    t = triangle_of(entered);
    if (!mesh.cells[t].vertex[0].is_valid() || !mesh.cells[t].vertex[1].is_valid() || !mesh.cells[t].vertex[2].is_valid()) return {Kind::outside, entered};
    first = static_cast<std::uint32_t>((step * 2654435761u) >> 16) % 3;
  }
  return {Kind::lost, halfedge(t, 0)};
}

void fill_cavity(Triangulation& mesh, VertexId p, Cavity& cavity) {
  const std::size_t n = cavity.border.size();
  // A cavity of T triangles without inner vertices has T + 2 edges (T + 1 when the fan is open).
  while (cavity.triangles.size() < n) cavity.triangles.push_back(mesh.new_cell());
  while (cavity.triangles.size() > n) {
    mesh.free_cell(cavity.triangles.back());
    cavity.triangles.pop_back();
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Cavity::BorderEdge& edge = cavity.border[i];
    const TriangleId t = cavity.triangles[i];
    const bool is_first = i == 0, is_last = i + 1 == n;
    Cell& cell = mesh.cells[t];
    cell.vertex = {edge.from, edge.to, p};
    cell.twin[0] = edge.outer;
    cell.twin[1] = is_last && cavity.is_open ? HalfedgeId{} : halfedge(cavity.triangles[is_last ? 0 : i + 1], 2);
    cell.twin[2] = is_first && cavity.is_open ? HalfedgeId{} : halfedge(cavity.triangles[is_first ? n - 1 : i - 1], 1);
    cell.flags = {edge.flags, k_free_edge, k_free_edge};
    ++cell.stamp;
    if (edge.outer.is_valid()) mesh.set_twin(edge.outer, halfedge(t, 0));
    if (edge.from.is_valid()) mesh.outgoing[edge.from] = halfedge(t, 0);
  }
  if (cavity.is_open) mesh.outgoing[cavity.border.back().to] = halfedge(cavity.triangles[n - 1], 1);
  mesh.outgoing[p] = halfedge(cavity.triangles[0], 2);
}

}  // namespace sterna::delaunay
