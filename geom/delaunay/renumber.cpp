#include "geom/delaunay/renumber.h"

#include <algorithm>

#include "geom/delaunay/insertion_order.h"

namespace sterna::delaunay {
namespace {

/// Border vertices unchanged, then the inner ones that are in use, along the curve.
Column<VertexId, VertexId> order_vertices(const SurfaceTriangulation& surface) {
  std::vector<VertexId> inner;
  std::vector<Vec2> locations;
  Column<VertexId, VertexId> old_id;
  for (const VertexId v : surface.mesh.uv.ids()) {
    if (surface.is_border(v)) {
      old_id.push_back(v);
    } else if (surface.mesh.outgoing[v].is_valid()) {
      inner.push_back(v);
      locations.push_back(surface.mesh.uv[v]);
    }
  }
  old_id.reserve(old_id.size() + inner.size());
  for (const std::uint32_t i : order_along_curve(locations)) old_id.push_back(inner[i]);
  return old_id;
}

/// Returns the existing triangles sorted by the lowest of their new vertices; ties in the old order.
std::vector<TriangleId> order_triangles(const Triangulation& mesh, const Column<VertexId, VertexId>& new_id, std::size_t n_vertices) {
  const auto least = [&](TriangleId t) {
    const auto& v = mesh.cells[t].vertex;
    return std::min({new_id[v[0]], new_id[v[1]], new_id[v[2]]}).index();
  };
  std::vector<std::uint32_t> first(n_vertices + 1, 0);
  for (const TriangleId t : mesh.cells.ids())
    if (!mesh.cells[t].is_dead) ++first[least(t) + 1];
  for (std::size_t i = 0; i < n_vertices; ++i) first[i + 1] += first[i];
  std::vector<TriangleId> old_id(mesh.n_triangles());
  for (const TriangleId t : mesh.cells.ids())
    if (!mesh.cells[t].is_dead) old_id[first[least(t)]++] = t;
  return old_id;
}

template <class T>
Column<VertexId, T> permuted(const Column<VertexId, T>& values, const Column<VertexId, VertexId>& old_id) {
  Column<VertexId, T> result;
  result.reserve(old_id.size());
  for (const VertexId v : old_id) result.push_back(values[v]);
  return result;
}

}  // namespace

Column<VertexId, VertexId> renumber(SurfaceTriangulation& surface) {
  Triangulation& mesh = surface.mesh;
  const Column<VertexId, VertexId> old_vertex = order_vertices(surface);
  Column<VertexId, VertexId> new_vertex(mesh.uv.size());
  for (const VertexId v : old_vertex.ids()) new_vertex[old_vertex[v]] = v;
  const std::vector<TriangleId> old_triangle = order_triangles(mesh, new_vertex, old_vertex.size());
  Column<TriangleId, TriangleId> new_triangle(mesh.cells.size());
  for (std::size_t t = 0; t < old_triangle.size(); ++t) new_triangle[old_triangle[t]] = TriangleId(static_cast<std::uint64_t>(t));
  const auto renamed = [&](HalfedgeId h) { return h.is_valid() ? halfedge(new_triangle[triangle_of(h)], corner_of(h)) : h; };

  Column<TriangleId, Cell> cells;
  cells.reserve(old_triangle.size());
  for (const TriangleId t : old_triangle) {
    Cell cell = mesh.cells[t];
    for (std::size_t k = 0; k < 3; ++k) {
      cell.vertex[k] = new_vertex[cell.vertex[k]];
      cell.twin[k] = renamed(cell.twin[k]);
    }
    cells.push_back(cell);
  }
  mesh.cells = std::move(cells);
  mesh.free_cells.clear();
  mesh.uv = permuted(mesh.uv, old_vertex);
  mesh.outgoing = permuted(mesh.outgoing, old_vertex);
  for (HalfedgeId& h : mesh.outgoing) h = renamed(h);
  surface.points = permuted(surface.points, old_vertex);
  surface.frames = permuted(surface.frames, old_vertex);
  surface.stands_for = permuted(surface.stands_for, old_vertex);
  for (VertexId& v : surface.stands_for) v = new_vertex[v];
  return old_vertex;
}

}  // namespace sterna::delaunay
