#include "geom/mesh/tri_mesh.h"

#include <algorithm>

namespace sterna {

std::string_view to_string(PatchKind kind) {
  switch (kind) {
    case PatchKind::wall: return "wall";
    case PatchKind::slip: return "slip";
    case PatchKind::symmetry: return "symmetry";
    case PatchKind::inflow: return "inflow";
    case PatchKind::outflow: return "outflow";
    case PatchKind::farfield: return "farfield";
    case PatchKind::interface: return "interface";
  }
  return "wall";
}

void Box::add(const Vec3& p) {
  min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
  max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
}

void Box::add(const Box& b) {
  if (b.empty()) return;
  add(b.min);
  add(b.max);
}

double Box::longest_side() const { return empty() ? 0.0 : std::max({max.x - min.x, max.y - min.y, max.z - min.z}); }

Box bounding_box(const TriMesh& mesh) {
  Box box;
  for (const Point& p : mesh.points) box.add(p);
  return box;
}

double body_length(const TriMesh& wall) { return bounding_box(wall).longest_side(); }

void append(TriMesh& mesh, const TriMesh& other) {
  const std::size_t n_vertices = mesh.n_vertices();
  std::vector<PatchId> other2mesh;
  for (const Patch& patch : other.patches) {
    const auto found = std::find(mesh.patches.begin(), mesh.patches.end(), patch);
    other2mesh.push_back(found != mesh.patches.end() ? PatchId(static_cast<std::uint64_t>(found - mesh.patches.begin())) : mesh.patches.push_back(patch));
  }
  for (const Point& p : other.points) mesh.points.push_back(p);
  for (const TriangleId t : other.triangles.ids()) {
    TriangleVertices v = other.triangles[t];
    for (VertexId& vertex : v) vertex = VertexId(static_cast<std::uint64_t>(n_vertices + vertex.index()));
    mesh.triangles.push_back(v);
    mesh.triangle_patch.push_back(other2mesh[other.triangle_patch[t].index()]);
  }
}

}  // namespace sterna
