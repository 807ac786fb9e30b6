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

void WorkMesh::split(HalfedgeId h) {
  const HalfedgeId o = twins[h];
  EditMesh::split(h);
  for (const HalfedgeId side : {h, o})
    if (side.is_valid()) hint.push_back(hint[triangle_of(side)]);
}

void WorkMesh::renumber() {
  Box box;
  for (const VertexId v : vertices.ids())
    if (outgoing[v].is_valid()) box.add(at(v));
  const double side = box.longest_side(), scale = side > 0.0 ? 0x1fffff / side : 0.0;
  std::vector<std::pair<std::uint64_t, VertexId>> order;
  for (const VertexId v : vertices.ids()) {
    if (!outgoing[v].is_valid()) continue;
    const Vec3 p = scale * (at(v) - box.min);
    order.emplace_back(spread(static_cast<std::uint64_t>(p.x)) | spread(static_cast<std::uint64_t>(p.y)) << 1 | spread(static_cast<std::uint64_t>(p.z)) << 2,
                       v);
  }
  std::sort(order.begin(), order.end());
  WorkMesh made;
  Column<VertexId, VertexId> new_vertex(vertices.size());
  for (const auto& [code, v] : order) new_vertex[v] = made.vertices.push_back(vertices[v]);
  std::vector<std::pair<VertexId, TriangleId>> by_vertex;
  for (const TriangleId t : triangles.ids()) {
    if (is_removed(t)) continue;
    for (VertexId& v : triangles[t]) v = new_vertex[v];
    by_vertex.emplace_back(std::ranges::min(triangles[t]), t);
  }
  std::sort(by_vertex.begin(), by_vertex.end());
  Column<TriangleId, TriangleId> new_triangle(triangles.size());
  for (const auto& [v, t] : by_vertex) {
    new_triangle[t] = made.triangles.push_back(triangles[t]);
    made.hint.push_back(hint[t]);
  }
  Column<HalfedgeId, HalfedgeId> new_twins;
  std::vector<std::int32_t> new_labels;
  for (const auto& [v, t] : by_vertex)
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId o = twins[halfedge(t, k)];
      new_twins.push_back(o.is_valid() ? halfedge(new_triangle[triangle_of(o)], corner_of(o)) : HalfedgeId());
      new_labels.push_back(labels[halfedge(t, k)]);
    }
  static_cast<EditMesh&>(made) = EditMesh(made.vertices.size(), std::move(made.triangles), std::move(new_twins));
  made.labels.raw() = std::move(new_labels);
  *this = std::move(made);
}

WorkMesh work_mesh_of(const Reference& r) {
  const TriMesh& mesh = *r.mesh;
  WorkMesh work{EditMesh(mesh, r.topology), {}, {}};
  work.labels = r.line;
  work.vertices.resize(mesh.n_vertices());
  work.hint.reserve(mesh.n_triangles());
  for (const TriangleId t : mesh.triangles.ids()) {
    work.hint.push_back(t);
    for (int k = 0; k < 3; ++k) {
      const VertexId v = mesh.triangles[t][k];
      WorkVertex& vertex = work.vertices[v];
      vertex.point = mesh.points[v];
      vertex.location = {t, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
      vertex.corner = v;
      if (r.is_corner[v] != 0) vertex.kind = VertexKind::corner;
    }
  }
  for (std::size_t l = 0; l < r.lines.size(); ++l)
    for (std::size_t i = 1; i + 1 < r.lines[l].vertices.size(); ++i) {
      WorkVertex& vertex = work.vertices[r.lines[l].vertices[i]];
      vertex.kind = VertexKind::line;
      vertex.line = static_cast<std::int32_t>(l);
      vertex.s = r.lines[l].lengths[i];
    }
  return work;
}

}  // namespace sterna::surfmesh
