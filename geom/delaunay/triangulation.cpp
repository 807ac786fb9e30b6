#include "geom/delaunay/triangulation.h"

namespace sterna::delaunay {

void Triangulation::set_flags(HalfedgeId h, EdgeFlags flags) {
  cells[triangle_of(h)].flags[corner_of(h)] = flags;
  if (const HalfedgeId other = twin(h); other.is_valid()) cells[triangle_of(other)].flags[corner_of(other)] = flags;
}

TriangleId Triangulation::new_cell() {
  if (free_cells.empty()) return cells.push_back(Cell{});
  const TriangleId t = free_cells.back();
  free_cells.pop_back();
  cells[t].is_dead = false;
  return t;
}

void Triangulation::free_cell(TriangleId t) {
  cells[t].is_dead = true;
  ++cells[t].stamp;
  free_cells.push_back(t);
}

bool is_flip_valid(const Triangulation& mesh, HalfedgeId h) {
  const HalfedgeId g = mesh.twin(h);
  if (!g.is_valid() || mesh.is_constrained(h)) return false;
  const VertexId a = mesh.origin(h), b = mesh.target(h), c = mesh.apex(h), d = mesh.apex(g);
  if (!a.is_valid() || !b.is_valid() || !c.is_valid() || !d.is_valid()) return false;
  return mesh.turn(d, c, a) > 0 && mesh.turn(d, c, b) < 0;
}

void flip(Triangulation& mesh, HalfedgeId h) {
  // a -> b with c to the left and d to the right becomes d -> c with b to the right, a to the left.
  const HalfedgeId g = mesh.twin(h);
  const TriangleId t = triangle_of(h), s = triangle_of(g);
  const VertexId a = mesh.origin(h), b = mesh.target(h), c = mesh.apex(h), d = mesh.apex(g);
  const HalfedgeId bc = next(h), ca = previous(h), ad = next(g), db = previous(g);
  const HalfedgeId out_bc = mesh.twin(bc), out_ca = mesh.twin(ca), out_ad = mesh.twin(ad), out_db = mesh.twin(db);
  const EdgeFlags flags_bc = mesh.flags(bc), flags_ca = mesh.flags(ca), flags_ad = mesh.flags(ad), flags_db = mesh.flags(db);
  const auto set = [&](HalfedgeId at, VertexId from, HalfedgeId out, EdgeFlags flags) {
    Cell& cell = mesh.cells[triangle_of(at)];
    cell.vertex[corner_of(at)] = from;
    cell.twin[corner_of(at)] = out;
    cell.flags[corner_of(at)] = flags;
    if (out.is_valid()) mesh.set_twin(out, at);
    mesh.outgoing[from] = at;
  };
  // The triangle t = (d, c, a) is left of the edge d -> c, the triangle s = (c, d, b) is right of it.
  set(bc, c, out_ca, flags_ca);
  set(ca, a, out_ad, flags_ad);
  set(ad, d, out_db, flags_db);
  set(db, b, out_bc, flags_bc);
  mesh.cells[t].vertex[corner_of(h)] = d;
  mesh.cells[s].vertex[corner_of(g)] = c;
  mesh.cells[t].flags[corner_of(h)] = mesh.cells[s].flags[corner_of(g)] = k_free_edge;
  ++mesh.cells[t].stamp;
  ++mesh.cells[s].stamp;
}

HalfedgeId find_edge(const Triangulation& mesh, VertexId a, VertexId b) {
  const HalfedgeId first = mesh.outgoing[a];
  if (!first.is_valid()) return {};
  HalfedgeId h = first;
  // Counter-clockwise; at the border of the domain the last edge runs towards a.
  do {
    if (mesh.target(h) == b) return h;
    const HalfedgeId in = previous(h);
    if (mesh.origin(in) == b && !mesh.twin(in).is_valid()) return {};
    h = mesh.twin(in);
  } while (h.is_valid() && h != first);
  if (h.is_valid()) return {};
  for (h = mesh.twin(first); h.is_valid(); h = mesh.twin(h)) {
    h = next(h);
    if (mesh.target(h) == b) return h;
  }
  return {};
}

}  // namespace sterna::delaunay
