// G20: tests that every symmetry patch lies in one plane, which is x, y or z = constant, or else the best-fit plane.
#include <cmath>
#include <cstdio>

#include "geom/base/number_text.h"
#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {
namespace {

/// Largest distance of a node from the plane of its symmetry patch, in body lengths (docs/method/quality.md, "Gates", G20).
constexpr double k_plane_tolerance = 1e-12;

/// Returns the longest side of the box of all walls, or of all boundaries if there are no walls.
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

/// Returns the median of the values. If most nodes lie in a plane, more than half of the values are equal.
long double median(std::vector<long double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A vector in extended precision: for an oblique plane the error is then that of the rounded nodes, not that of products.
struct Wide {
  long double x = 0.0L, y = 0.0L, z = 0.0L;
  Wide() = default;
  Wide(long double a, long double b, long double c) : x(a), y(b), z(c) {}
  explicit Wide(const Point& p) : x(p.x), y(p.y), z(p.z) {}
  friend Wide operator-(const Wide& a, const Wide& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Wide operator+(const Wide& a, const Wide& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend long double dot(const Wide& a, const Wide& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Wide cross(const Wide& a, const Wide& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
};

/// dot(normal, x) = offset, metres; the normal has unit length.
struct Plane {
  Wide normal;
  long double offset = 0.0L;
  std::string text;
  double distance(const Point& p) const { return static_cast<double>(dot(normal, Wide(p)) - offset); }
};

std::string text_of(const char* format, double a, double b, double c, double d) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c, d);
  return text;
}

/// Returns the plane with this normal that contains most nodes. \pre the normal is not zero
Plane plane_along(const HybridMesh& mesh, const std::vector<NodeId>& nodes, const Wide& normal) {
  const long double length = std::sqrt(dot(normal, normal));
  Plane plane{{normal.x / length, normal.y / length, normal.z / length}, 0.0L, {}};
  std::vector<long double> offsets;
  for (const NodeId node : nodes) offsets.push_back(dot(plane.normal, Wide(mesh.points[node])));
  plane.offset = median(std::move(offsets));
  plane.text = text_of("(%.9g, %.9g, %.9g) . x = %.9g m", static_cast<double>(plane.normal.x), static_cast<double>(plane.normal.y),
                       static_cast<double>(plane.normal.z), static_cast<double>(plane.offset));
  return plane;
}

Plane axis_plane(const HybridMesh& mesh, const std::vector<NodeId>& nodes, std::size_t axis) {
  Plane plane = plane_along(mesh, nodes, {axis == 0 ? 1.0L : 0.0L, axis == 1 ? 1.0L : 0.0L, axis == 2 ? 1.0L : 0.0L});
  char text[80];
  std::snprintf(text, sizeof text, "%c = %.9g m", "xyz"[axis], static_cast<double>(plane.offset));
  plane.text = text;
  return plane;
}

/// Returns the area-weighted sum of the face normals. It depends only on the boundary edges of the patch: inner nodes off the plane do not tilt it.
Wide area_vector(const HybridMesh& mesh, PatchId patch, const Wide& origin) {
  Wide sum;
  const auto add = [&](const auto& faces) {
    for (const auto& face : faces) {
      if (face.patch != patch) continue;
      const Wide first = Wide(mesh.points[face.nodes[0]]) - origin;
      for (std::size_t k = 2; k < face.nodes.size(); ++k)
        sum = sum + cross(Wide(mesh.points[face.nodes[k - 1]]) - origin - first, Wide(mesh.points[face.nodes[k]]) - origin - first);
    }
  };
  add(mesh.boundary_triangles);
  add(mesh.boundary_quads);
  return sum;
}

/// Returns a plane through three nodes far from each other. Candidates are half of the nodes: those nearest to the plane perpendicular to the area vector. A
/// boundary node off the plane tilts that vector slightly, but is not among the candidates. Uses the area vector itself if the patch has no area or the three
/// nodes are collinear.
Plane oblique_plane(const HybridMesh& mesh, PatchId patch, std::vector<NodeId> nodes) {
  const std::vector<NodeId> all = nodes;
  const Wide first(mesh.points[nodes.front()]);
  const Wide across = area_vector(mesh, patch, first);
  if (!(dot(across, across) > 0.0L)) return axis_plane(mesh, nodes, 0);
  const Plane guess = plane_along(mesh, nodes, across);
  const auto half = nodes.begin() + static_cast<std::ptrdiff_t>((nodes.size() + 1) / 2);
  std::sort(nodes.begin(), nodes.end(), [&](NodeId a, NodeId b) {
    return std::pair(std::abs(guess.distance(mesh.points[a])), a) < std::pair(std::abs(guess.distance(mesh.points[b])), b);
  });
  nodes.erase(half, nodes.end());
  const auto farthest = [&](const auto& measure) {
    NodeId best = nodes.front();
    for (const NodeId node : nodes)
      if (measure(mesh.points[node]) > measure(mesh.points[best])) best = node;
    return mesh.points[best];
  };
  const Point a = farthest([&](const Point& p) { return distance(p, mesh.points[nodes.front()]); });
  const Point b = farthest([&](const Point& p) { return distance(p, a); });
  const Point c = farthest([&](const Point& p) { return norm(cross(b - a, p - a)); });
  const Wide normal = cross(Wide(b) - Wide(a), Wide(c) - Wide(a));
  return plane_along(mesh, all, dot(normal, normal) > 0.0L ? normal : across);
}

std::vector<NodeId> nodes_off(const HybridMesh& mesh, const std::vector<NodeId>& nodes, const Plane& plane, double tolerance) {
  std::vector<NodeId> off;
  for (const NodeId node : nodes)
    if (!(std::abs(plane.distance(mesh.points[node])) <= tolerance)) off.push_back(node);
  return off;
}

}  // namespace

void check_symmetry(const HybridMesh& mesh, const RunContext& context, Findings& findings) {
  for (const PatchId patch : mesh.patches.ids()) {
    if (mesh.patches[patch].kind != PatchKind::symmetry) continue;
    context.check_stop();
    const std::vector<NodeId> nodes = nodes_of(mesh, patch);
    if (nodes.empty()) continue;
    const double tolerance = k_plane_tolerance * length_of(mesh);
    Plane plane = axis_plane(mesh, nodes, 0);
    std::vector<NodeId> off = nodes_off(mesh, nodes, plane, tolerance);
    const auto consider = [&](Plane other) {
      std::vector<NodeId> off_other = nodes_off(mesh, nodes, other, tolerance);
      if (off_other.size() >= off.size()) return;
      off = std::move(off_other);
      plane = std::move(other);
    };
    for (const std::size_t axis : {1u, 2u})
      if (!off.empty()) consider(axis_plane(mesh, nodes, axis));
    if (2 * off.size() > nodes.size()) consider(oblique_plane(mesh, patch, nodes));  // not an axis-parallel plane
    for (const NodeId node : off)
      findings.add(Violation::off_symmetry_plane, [&] {
        return std::pair(mesh.points[node], "node " + std::to_string(node.value()) + " of patch " + patch_name(mesh, patch) + " is " +
                                                number_text(plane.distance(mesh.points[node]), 3) + " m off the plane " + plane.text + ", limit " +
                                                number_text(tolerance, 3) + " m");
      });
  }
}

}  // namespace sterna::check_parts
