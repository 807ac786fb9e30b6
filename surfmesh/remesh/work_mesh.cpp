#include "surfmesh/remesh/work_mesh.h"

#include <algorithm>
#include <utility>

#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {
namespace {

/// Spreads the lower 21 bits to every third bit.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

}  // namespace

bool WorkMesh::is_edge(std::uint32_t a, std::uint32_t b) const {
  bool found = false;
  for_ring(a, [&](std::uint32_t v) { found = found || v == b; });
  return found;
}

void WorkMesh::join(std::uint32_t a, std::uint32_t b, std::int32_t l) {
  if (a != k_none) {
    twin[a] = b;
    line[a] = l;
  }
  if (b != k_none) {
    twin[b] = a;
    line[b] = l;
  }
}

void WorkMesh::split(std::uint32_t h, std::uint32_t m) {
  const std::uint32_t o = twin[h];
  const std::int32_t l = line[h];
  // On each side, the triangle (a, b, c) on the edge a b becomes (a, m, c), and the triangle (m, b, c) is added.
  const auto halve = [&](std::uint32_t e) {
    const std::uint32_t t = e / 3, bc = next(e), c = apex(e), b = to(e);
    const auto n = static_cast<std::uint32_t>(triangles.size());
    const std::uint32_t outer = twin[bc];
    const std::int32_t outer_line = line[bc];
    triangles.push_back({m, b, c});
    hint.push_back(hint[t]);
    twin.insert(twin.end(), 3, k_none);
    line.insert(line.end(), 3, k_no_line);
    triangles[t][bc % 3] = m;
    join(3 * n + 1, outer, outer_line);
    join(bc, 3 * n + 2, k_no_line);
    vertices[m].out = 3 * n;
    vertices[b].out = 3 * n + 1;
    vertices[c].out = 3 * n + 2;
    return 3 * n;  // half-edge from m to b
  };
  const std::uint32_t a = from(h);
  const std::uint32_t second = halve(h);
  if (o == k_none) {
    join(h, k_none, l);
    join(second, k_none, l);
  } else {
    const std::uint32_t second_o = halve(o);  // half-edge from m to a
    join(h, second_o, l);
    join(second, o, l);
  }
  vertices[a].out = h;
}

void WorkMesh::collapse(std::uint32_t h) {
  const std::uint32_t v = from(h), u = to(h), o = twin[h];
  for_out(v, [&](std::uint32_t e) {
    if (e != h && e / 3 != (o == k_none ? k_none : o / 3)) triangles[e / 3][e % 3] = u;
  });
  const auto close = [&](std::uint32_t e) {
    // The triangle of e is removed, and its two other edges become one edge. If one of them is on a line, the new edge is on that line.
    const std::uint32_t p = next(e), q = prev(e), c = apex(e);
    const std::uint32_t tp = twin[p], tq = twin[q];
    const std::int32_t l = line[p] != k_no_line ? line[p] : line[q];
    const std::uint32_t t = e / 3;
    if (tp != k_none) {
      twin[tp] = tq;
      line[tp] = l;
    }
    if (tq != k_none) {
      twin[tq] = tp;
      line[tq] = l;
    }
    // The half-edge of one outer triangle begins at c, that of the other at u.
    const std::uint32_t outer = tp != k_none ? tp : tq;
    for (const std::uint32_t x : {outer, next(outer), prev(outer)}) {
      const std::uint32_t w = from(x);
      if (w == c || w == u) vertices[w].out = x;
    }
    triangles[t] = {k_none, k_none, k_none};
  };
  close(h);
  if (o != k_none) close(o);
  vertices[v].out = k_none;
}

void WorkMesh::flip(std::uint32_t h) {
  const std::uint32_t o = twin[h];
  const std::uint32_t a = from(h), b = to(h), c = apex(h), d = apex(o);
  const std::uint32_t bc = next(h), ca = prev(h), ad = next(o), db = prev(o);
  const std::uint32_t t_bc = twin[bc], t_ca = twin[ca], t_ad = twin[ad], t_db = twin[db];
  const std::int32_t l_bc = line[bc], l_ca = line[ca], l_ad = line[ad], l_db = line[db];
  const std::uint32_t t = h / 3, u = o / 3;
  triangles[t] = {c, d, b};
  triangles[u] = {d, c, a};
  join(3 * t, 3 * u, k_no_line);
  join(3 * t + 1, t_db, l_db);
  join(3 * t + 2, t_bc, l_bc);
  join(3 * u + 1, t_ca, l_ca);
  join(3 * u + 2, t_ad, l_ad);
  vertices[a].out = 3 * u + 2;
  vertices[b].out = 3 * t + 2;
  vertices[c].out = 3 * t;
  vertices[d].out = 3 * u;
}

void WorkMesh::renumber() {
  Box box;
  for (const WorkVertex& v : vertices)
    if (v.out != k_none) box.add(v.point);
  const double side = box.longest_side(), scale = side > 0.0 ? 0x1fffff / side : 0.0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v].out == k_none) continue;
    const Vec3 p = scale * (vertices[v].point - box.min);
    order.emplace_back(spread(static_cast<std::uint64_t>(p.x)) | spread(static_cast<std::uint64_t>(p.y)) << 1 | spread(static_cast<std::uint64_t>(p.z)) << 2,
                       v);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> new_vertex(vertices.size(), k_none), new_triangle(triangles.size(), k_none);
  std::vector<WorkVertex> old_vertices = std::move(vertices);
  vertices.clear();
  for (const auto& [code, v] : order) {
    new_vertex[v] = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(old_vertices[v]);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_vertex;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (is_gone(t)) continue;
    for (std::uint32_t& v : triangles[t]) v = new_vertex[v];
    by_vertex.emplace_back(*std::min_element(triangles[t].begin(), triangles[t].end()), t);
  }
  std::sort(by_vertex.begin(), by_vertex.end());
  const WorkMesh old = std::move(*this);
  *this = WorkMesh{};
  vertices = old.vertices;
  for (const auto& [v, t] : by_vertex) {
    new_triangle[t] = static_cast<std::uint32_t>(triangles.size());
    triangles.push_back(old.triangles[t]);
    hint.push_back(old.hint[t]);
  }
  twin.resize(3 * triangles.size());
  line.resize(3 * triangles.size());
  for (const auto& [v, t] : by_vertex)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t h = 3 * new_triangle[t] + k, o = old.twin[3 * t + k];
      twin[h] = o == k_none ? k_none : 3 * new_triangle[o / 3] + o % 3;
      line[h] = old.line[3 * t + k];
      vertices[triangles[h / 3][k]].out = h;
    }
}

WorkMesh work_mesh_of(const Reference& r) {
  const TriMesh& mesh = *r.mesh;
  WorkMesh work;
  work.vertices.resize(mesh.n_vertices());
  work.triangles.resize(mesh.n_triangles());
  work.twin.resize(r.topology.n_halfedges());
  work.line.resize(r.topology.n_halfedges());
  work.hint.resize(mesh.n_triangles());
  for (const TriangleId t : mesh.triangles.ids()) {
    work.hint[t.index()] = t;
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(t, k), o = r.topology.twin(h);
      const VertexId v = mesh.triangles[t][static_cast<std::size_t>(k)];
      work.triangles[t.index()][static_cast<std::size_t>(k)] = v.value();
      work.twin[h.index()] = o.is_valid() ? o.value() : k_none;
      work.line[h.index()] = r.line[h];
      WorkVertex& vertex = work.vertices[v.index()];
      vertex.point = mesh.points[v];
      vertex.out = h.value();
      vertex.location = {t, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
      vertex.corner = v;
      if (r.is_corner[v] != 0) vertex.kind = VertexKind::corner;
    }
  }
  for (std::size_t l = 0; l < r.lines.size(); ++l)
    for (std::size_t i = 1; i + 1 < r.lines[l].vertices.size(); ++i) {
      WorkVertex& vertex = work.vertices[r.lines[l].vertices[i].index()];
      vertex.kind = VertexKind::line;
      vertex.line = static_cast<std::int32_t>(l);
      vertex.s = r.lines[l].lengths[i];
    }
  return work;
}

}  // namespace sterna::surfmesh
