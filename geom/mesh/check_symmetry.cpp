// G20: every symmetry patch lies in one plane of constant x, y or z.
#include <cmath>

#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {
namespace {

/// Largest distance of a node from the plane of its symmetry patch, in body lengths (quality.md, G20).
constexpr double k_plane_tolerance = 1e-12;

/// Longest side of the box of all walls; of all boundaries when there is none.
double length_of(const HybridMesh& mesh) {
  Box walls, all;
  const auto look_at = [&](const auto& faces) {
    for (const auto& face : faces) {
      const bool is_wall = face.patch.index() < mesh.patches.size() && mesh.patches[face.patch].kind == PatchKind::wall;
      for (const NodeId node : face.nodes) {
        all.add(mesh.points[node]);
        if (is_wall) walls.add(mesh.points[node]);
      }
    }
  };
  look_at(mesh.boundary_triangles);
  look_at(mesh.boundary_quads);
  return (walls.empty() ? all : walls).longest_side();
}

std::vector<NodeId> nodes_of(const HybridMesh& mesh, PatchId patch) {
  std::vector<NodeId> nodes;
  const auto collect = [&](const auto& faces) {
    for (const auto& face : faces)
      if (face.patch == patch) nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.end());
  };
  collect(mesh.boundary_triangles);
  collect(mesh.boundary_quads);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Median of one coordinate: that of the plane, when most nodes lie in it.
double median(const HybridMesh& mesh, const std::vector<NodeId>& nodes, std::size_t axis) {
  std::vector<double> values;
  for (const NodeId node : nodes) values.push_back(mesh.points[node][axis]);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void check_symmetry(const HybridMesh& mesh, const RunContext& context, Findings& findings) {
  for (const PatchId patch : mesh.patches.ids()) {
    if (mesh.patches[patch].kind != PatchKind::symmetry) continue;
    context.check_stop();
    const std::vector<NodeId> nodes = nodes_of(mesh, patch);
    if (nodes.empty()) continue;
    const double tolerance = k_plane_tolerance * length_of(mesh);
    std::vector<NodeId> off;
    std::size_t plane_axis = 0;
    double plane = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = median(mesh, nodes, axis);
      std::vector<NodeId> off_this;
      for (const NodeId node : nodes)
        if (!(std::abs(mesh.points[node][axis] - value) <= tolerance)) off_this.push_back(node);
      if (axis > 0 && off_this.size() >= off.size()) continue;
      off = std::move(off_this);
      plane_axis = axis;
      plane = value;
    }
    for (const NodeId node : off)
      findings.add(Violation::off_symmetry_plane, [&] {
        char text[160];
        std::snprintf(text, sizeof text, " is %.3g m off the plane %c = %.9g m, limit %.3g m", mesh.points[node][plane_axis] - plane, "xyz"[plane_axis], plane, tolerance);
        return std::pair(mesh.points[node], "node " + std::to_string(node.value()) + " of patch " + patch_name(mesh, patch) + text);
      });
  }
}

}  // namespace sterna::check_parts
