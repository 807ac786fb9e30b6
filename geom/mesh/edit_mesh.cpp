#include "geom/mesh/edit_mesh.h"

#include <algorithm>
#include <utility>

namespace sterna {

EditMesh::EditMesh(std::size_t n_vertices, Column<TriangleId, TriangleVertices> given_triangles, Column<HalfedgeId, HalfedgeId> given_twins)
    : triangles(std::move(given_triangles)), twins(std::move(given_twins)), labels(twins.size(), k_no_label), outgoing(n_vertices) {
  for (const HalfedgeId h : twins.ids()) outgoing[from(h)] = h;
}

EditMesh::EditMesh(const TriMesh& mesh, const Topology& topology) : EditMesh(mesh.n_vertices(), mesh.triangles, topology.twins()) {}

bool EditMesh::is_edge(HalfedgeId first, VertexId other) const {
  bool is_found = false;
  for_out(first, [&](HalfedgeId h) { is_found = is_found || to(h) == other || apex(h) == other; });
  return is_found;
}

void EditMesh::join(HalfedgeId a, HalfedgeId b, std::int32_t label) {
  if (a.is_valid()) {
    twins[a] = b;
    labels[a] = label;
  }
  if (b.is_valid()) {
    twins[b] = a;
    labels[b] = label;
  }
}

void EditMesh::flip(HalfedgeId h, const TriangleVertices& first, const TriangleVertices& second) {
  const HalfedgeId o = twins[h];
  struct Side {
    VertexId from;
    HalfedgeId twin;
    std::int32_t label;
  };
  std::array<Side, 4> sides;  // of the quadrilateral; their start vertices are its four vertices
  for (std::size_t i = 0; const HalfedgeId s : {next(h), previous(h), next(o), previous(o)}) sides[i++] = {from(s), twins[s], labels[s]};
  const VertexId c = apex(h), d = apex(o);
  triangles[triangle_of(h)] = first;
  triangles[triangle_of(o)] = second;
  std::array<HalfedgeId, 2> diagonal;  // from c to d and back
  for (const TriangleId t : {triangle_of(h), triangle_of(o)})
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId s = halfedge(t, k);
      const VertexId a = from(s), b = to(s);
      if ((a == c && b == d) || (a == d && b == c)) {
        diagonal[a == c ? 0 : 1] = s;
        continue;
      }
      const Side& side = *std::ranges::find(sides, a, &Side::from);
      join(s, side.twin, side.label);
      outgoing[a] = s;
    }
  join(diagonal[0], diagonal[1], k_no_label);
  outgoing[c] = diagonal[0];
  outgoing[d] = diagonal[1];
}

/// Splits the triangle of h. Returns the new half-edge from m to the end of h; its twin is not set yet.
HalfedgeId EditMesh::halve(HalfedgeId h, VertexId m) {
  const HalfedgeId bc = next(h);
  const VertexId b = from(bc), c = apex(h);
  const TriangleId made = triangles.push_back({m, b, c});
  const HalfedgeId mb = halfedge(made, 0), made_bc = halfedge(made, 1), cm = halfedge(made, 2);
  twins.resize(3 * triangles.size());
  labels.resize(3 * triangles.size(), k_no_label);
  triangles[triangle_of(h)][corner_of(bc)] = m;
  join(made_bc, twins[bc], labels[bc]);
  join(bc, cm, k_no_label);
  outgoing[m] = mb;
  outgoing[b] = made_bc;
  outgoing[c] = cm;
  return mb;
}

VertexId EditMesh::split(HalfedgeId h) {
  const HalfedgeId o = twins[h];
  const std::int32_t label = labels[h];
  const VertexId a = from(h), m = outgoing.push_back({});
  const HalfedgeId second = halve(h, m);
  const HalfedgeId second_o = o.is_valid() ? halve(o, m) : HalfedgeId();
  join(h, second_o, label);
  join(second, o, label);
  outgoing[a] = h;
  return m;
}

/// Removes the triangle of h, an edge that collapsed into the vertex u. Its two other edges become one edge; if one of them has a label, the edge gets it.
void EditMesh::close(HalfedgeId h, VertexId u) {
  const HalfedgeId p = next(h), q = previous(h), tp = twins[p], tq = twins[q];
  const VertexId c = from(q);
  join(tp, tq, labels[p] != k_no_label ? labels[p] : labels[q]);
  // The half-edge of one outer triangle begins at c, that of the other at u.
  const HalfedgeId outer = tp.is_valid() ? tp : tq;
  for (const HalfedgeId x : {outer, next(outer), previous(outer)})
    if (const VertexId w = from(x); w == c || w == u) outgoing[w] = x;
  triangles[triangle_of(h)] = {};
}

void EditMesh::collapse(HalfedgeId h) {
  const VertexId v = from(h), u = to(h);
  const HalfedgeId o = twins[h];
  for_out(v, [&](HalfedgeId e) {
    if (e != h && (!o.is_valid() || triangle_of(e) != triangle_of(o))) triangles[triangle_of(e)][corner_of(e)] = u;
  });
  close(h, u);
  if (o.is_valid()) close(o, u);
  outgoing[v] = {};
}

void EditMesh::rotate(TriangleId t, int first) {
  if (first == 0) return;
  std::array<HalfedgeId, 3> outer;
  std::array<std::int32_t, 3> label;
  std::array<VertexId, 3> v;
  std::array<bool, 3> is_outgoing;
  for (int k = 0; k < 3; ++k) {
    const HalfedgeId h = halfedge(t, (first + k) % 3);
    v[k] = from(h);
    outer[k] = twins[h];
    label[k] = labels[h];
    is_outgoing[k] = outgoing[v[k]] == h;
  }
  triangles[t] = v;
  for (int k = 0; k < 3; ++k) {
    join(halfedge(t, k), outer[k], label[k]);
    if (is_outgoing[k]) outgoing[v[k]] = halfedge(t, k);
  }
}

}  // namespace sterna
