#include "tests/support/class_bodies.h"

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "tests/support/test_shapes.h"

namespace sterna::test {
namespace {

constexpr int k_wing_points = 20;  ///< along the chord, on each side
constexpr int k_wing_sections = 6;

void add_wall_triangle(TriMesh& mesh, VertexId a, VertexId b, VertexId c) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangle_patch.push_back(PatchId(0));
}

/// Returns the half thickness of a closed 20 % symmetric section of the NACA four-digit family, plus a wedge that opens the trailing edge.
double half_thickness(double x, double trailing) {
  const double closed = 0.2969 * std::sqrt(x) - 0.1260 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x;
  return x == 0.0 ? 0.0 : x == 1.0 ? 0.5 * trailing : closed + 0.5 * trailing * x;
}

/// Returns the surface of the union of unit boxes, each square as two triangles, normals outward.
TriMesh boxes(const std::set<std::tuple<int, int, int>>& filled) {
  TriMesh mesh;
  mesh.patches.push_back({"boxes", PatchKind::wall});
  std::map<std::array<int, 3>, VertexId> known;
  const auto at = [&](const std::array<int, 3>& p) {
    const auto [entry, is_new] = known.try_emplace(p);
    if (is_new) entry->second = mesh.points.push_back({double(p[0]), double(p[1]), double(p[2])});
    return entry->second;
  };
  for (const auto& [i, j, k] : filled) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        std::array<int, 3> other = {i, j, k};
        other[axis] += side == 1 ? 1 : -1;
        if (filled.contains({other[0], other[1], other[2]})) continue;
        const auto corner = [&](int u, int v) {
          std::array<int, 3> p = {i, j, k};
          p[axis] += side;
          p[(axis + 1) % 3] += u;
          p[(axis + 2) % 3] += v;
          return at(p);
        };
        const VertexId a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
        if (side == 1) add_wall_triangle(mesh, a, b, c), add_wall_triangle(mesh, a, c, d);
        else add_wall_triangle(mesh, a, c, b), add_wall_triangle(mesh, a, d, c);
      }
    }
  }
  return mesh;
}

}  // namespace

TriMesh straight_wing(double thickness) {
  TriMesh mesh;
  mesh.patches.push_back({"wing", PatchKind::wall});
  // The section runs from the trailing edge over the upper side to the nose and back below; a sharp edge has one point, a blunt edge two.
  std::vector<Point> section;
  const auto x_of = [](int i) { return 0.5 * (1.0 + std::cos(std::numbers::pi * i / k_wing_points)); };
  for (int i = 0; i <= k_wing_points; ++i) {
    const double x = i == 0 ? 1.0 : i == k_wing_points ? 0.0 : x_of(i);
    section.push_back({x, 0, half_thickness(x, thickness)});
  }
  for (int i = k_wing_points - 1; i >= (thickness > 0.0 ? 0 : 1); --i) {
    const double x = i == 0 ? 1.0 : x_of(i);
    section.push_back({x, 0, -half_thickness(x, thickness)});
  }
  const int m = static_cast<int>(section.size());
  for (int s = 0; s <= k_wing_sections; ++s)
    for (Point p : section) {
      p.y = static_cast<double>(s) / k_wing_sections;
      mesh.points.push_back(p);
    }
  const auto at = [&](int s, int i) { return VertexId(s * m + i % m); };
  for (int s = 0; s < k_wing_sections; ++s)
    for (int i = 0; i < m; ++i) {
      add_wall_triangle(mesh, at(s, i), at(s + 1, i + 1), at(s, i + 1));
      add_wall_triangle(mesh, at(s, i), at(s + 1, i), at(s + 1, i + 1));
    }
  // Flat ends: strips between point i of the upper side and the point below it on the lower side.
  const auto below = [&](int i) { return 2 * k_wing_points - i; };
  for (const int s : {0, k_wing_sections}) {
    const auto cap = [&](int i, int j, int k) {
      if (s == 0) add_wall_triangle(mesh, at(s, i), at(s, j), at(s, k));
      else add_wall_triangle(mesh, at(s, i), at(s, k), at(s, j));
    };
    for (int i = 0; i < k_wing_points; ++i) {
      if (below(i + 1) != i + 1) cap(i, i + 1, below(i + 1));
      if (below(i) % m != i) cap(i, i + 1 == below(i + 1) ? i + 1 : below(i + 1), below(i));
    }
  }
  return mesh;
}

TriMesh wing_body() {
  std::set<std::tuple<int, int, int>> filled;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) filled.insert({i, j, k});
  for (int i = 2; i < 6; ++i)
    for (int j = 3; j < 8; ++j) filled.insert({i, j, 1});
  return boxes(filled);
}

TriMesh creased_disk() {
  TriMesh mesh;
  mesh.patches.push_back({"disk", PatchKind::wall});
  constexpr int n = 24;
  const double slope = std::tan(std::numbers::pi / 6.0);
  const VertexId centre = mesh.points.push_back({0, 0, 0});
  for (const double r : {0.5, 1.0, -1.0})  // two rings of the top, then the ring of the bottom
    for (int i = 0; i < n; ++i) {
      const double phi = 2.0 * std::numbers::pi * i / n;
      const double s = i % (n / 2) == 0 ? 0.0 : std::sin(phi);
      const double c = i == 0 ? 1.0 : i == n / 2 ? -1.0 : std::cos(phi);
      mesh.points.push_back({std::abs(r) * c, std::abs(r) * s, r > 0.0 ? r * slope * std::abs(s) * c : -1.0});
    }
  const VertexId bottom = mesh.points.push_back({0, 0, -1});
  const auto at = [&](int ring, int i) { return VertexId(1 + ring * n + i % n); };
  for (int i = 0; i < n; ++i) {
    add_wall_triangle(mesh, centre, at(0, i), at(0, i + 1));
    for (int ring = 0; ring < 2; ++ring) {
      add_wall_triangle(mesh, at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
      add_wall_triangle(mesh, at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
    add_wall_triangle(mesh, at(2, i), bottom, at(2, i + 1));
  }
  return mesh;
}

TriMesh cone(double half_angle, int n) {
  TriMesh mesh;
  mesh.patches.push_back({"cone", PatchKind::wall});
  constexpr int k_rings = 4;
  const VertexId tip = mesh.points.push_back({0, 0, 1});
  for (int ring = 1; ring <= k_rings; ++ring)
    for (int i = 0; i < n; ++i) {
      const double depth = static_cast<double>(ring) / k_rings, phi = 2.0 * std::numbers::pi * i / n;
      const double r = depth * std::tan(half_angle);
      mesh.points.push_back({r * std::cos(phi), r * std::sin(phi), 1.0 - depth});
    }
  const VertexId base = mesh.points.push_back({0, 0, 0});
  const auto at = [&](int ring, int i) { return VertexId(1 + (ring - 1) * n + i % n); };
  for (int i = 0; i < n; ++i) {
    add_wall_triangle(mesh, tip, at(1, i), at(1, i + 1));
    for (int ring = 1; ring < k_rings; ++ring) {
      add_wall_triangle(mesh, at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
      add_wall_triangle(mesh, at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
    }
    add_wall_triangle(mesh, at(k_rings, i), base, at(k_rings, i + 1));
  }
  return mesh;
}

}  // namespace sterna::test
