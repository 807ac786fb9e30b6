#include "tests/support/half_shapes.h"

#include <algorithm>
#include <cmath>

#include "tests/support/halves.h"
#include "tests/support/test_shapes.h"

namespace sterna::test {
namespace {

/// Returns the vertices of the open boundary, ordered by their angle about y.
std::vector<std::uint32_t> border_of(const TriMesh& wall) {
  std::vector<std::uint32_t> border;
  for (const VertexId v : wall.points.ids())
    if (wall.points[v].y == 0.0) border.push_back(v.value());
  const auto angle = [&](std::uint32_t v) { return std::atan2(wall.points[VertexId(v)].z, wall.points[VertexId(v)].x); };
  std::sort(border.begin(), border.end(), [&](std::uint32_t a, std::uint32_t b) { return angle(a) < angle(b); });
  return border;
}

std::vector<std::uint32_t> collapsed_at(const TriMesh& wall) {
  const std::vector<std::uint32_t> border = border_of(wall);
  const std::size_t n = border.size();
  std::vector<std::uint32_t> collapsed = {border[0], border[n / 3], border[n / 3 + 1], border[2 * n / 3]};
  for (const TriangleVertices& t : wall.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (t[k].value() == border[2 * n / 3] && wall.points[t[(k + 1) % 3]].y > 0.0) {
        collapsed.push_back(t[(k + 1) % 3].value());
        return collapsed;
      }
  return collapsed;
}

}  // namespace

HybridMesh half_sphere_shell(int f, const HalfShellOptions& options) {
  const TriMesh wall = cut_off(sphere(f), 1, 0.0);
  ShellOptions shell = options.shell;
  if (options.has_collapsed_border) shell.collapsed = collapsed_at(wall);
  HybridMesh mesh = extrude(wall, rays_from(wall, {}), shell);
  for (Patch& patch : mesh.patches)
    if (patch.name == "side") patch = {"symmetry", PatchKind::symmetry};
  return mesh;
}

HybridMesh half_shell_of_all_kinds(int f, const HalfShellOptions& options) {
  HybridMesh mesh = half_sphere_shell(f, options);
  PatchId symmetry;
  for (const PatchId patch : mesh.patches.ids())
    if (mesh.patches[patch].kind == PatchKind::symmetry) symmetry = patch;
  const auto add = [&](const char* name, PatchKind kind) { return mesh.patches.push_back({name, kind}); };
  const PatchId slip = add("slip_wall", PatchKind::slip), inflow = add("inflow", PatchKind::inflow), outflow = add("outflow", PatchKind::outflow),
                disc = add("disc", PatchKind::interface);
  const auto assign = [&](auto& faces) {
    for (auto& face : faces) {
      if (face.patch != symmetry) continue;
      Point middle;
      for (const NodeId node : face.nodes) middle += mesh.points[node] / static_cast<double>(face.nodes.size());
      if (middle.x > 0.0 && std::abs(middle.z) < 0.5 * middle.x) face.patch = disc;
      else if (middle.x > 0.0) face.patch = middle.z > 0.0 ? inflow : outflow;
      else if (middle.z > 0.0) face.patch = slip;
    }
  };
  assign(mesh.boundary_triangles);
  assign(mesh.boundary_quads);
  return mesh;
}

HybridMesh turned(HybridMesh mesh, const Vec3& offset) {
  // Rodrigues' rotation formula, about (1, 2, 3) by 2.2 rad.
  const Vec3 axis = normalized(Vec3{1.0, 2.0, 3.0});
  const double c = std::cos(2.2), s = std::sin(2.2);
  for (Point& p : mesh.points) p = c * p + s * cross(axis, p) + (1.0 - c) * dot(axis, p) * axis + offset;
  return mesh;
}

}  // namespace sterna::test
