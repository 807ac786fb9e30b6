// A wing with one sharp edge: chord 1, a round nose, and a trailing edge along y.
#pragma once

#include <cmath>
#include <numbers>

#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// \param wedge_angle angle of the trailing edge, degrees; the trailing edge has n_span edges of 0.1 m
inline TriMesh sharp_wing(double wedge_angle, int n_span) {
  constexpr int k_along = 10, k_nose = 8;
  const double half = 0.5 * wedge_angle * std::numbers::pi / 180.0, slope = std::tan(half);
  std::vector<std::array<double, 2>> section;  // from the trailing edge over the upper side
  for (int i = 0; i <= k_along; ++i) section.push_back({1.0 - 0.1 * i, 0.1 * i * slope});
  for (int i = 1; i < k_nose; ++i) {
    const double angle = std::numbers::pi * (0.5 + static_cast<double>(i) / k_nose);
    section.push_back({slope * std::cos(angle), slope * std::sin(angle)});
  }
  for (int i = 0; i < k_along; ++i) section.push_back({0.1 * i, -slope * (1.0 - 0.1 * i)});
  TriMesh mesh;
  mesh.patches.push_back({"wing", PatchKind::wall});
  const int n = static_cast<int>(section.size());
  for (int j = 0; j <= n_span; ++j)
    for (const auto& [x, z] : section) mesh.points.push_back({x, 0.1 * j, z});
  const auto vertex = [&](int j, int i) { return VertexId(j * n + (i + n) % n); };
  const auto add = [&](VertexId a, VertexId b, VertexId c) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangle_patch.push_back(PatchId(0));
  };
  for (int j = 0; j < n_span; ++j)
    for (int i = 0; i < n; ++i) {
      add(vertex(j, i), vertex(j + 1, i + 1), vertex(j, i + 1));
      add(vertex(j, i), vertex(j + 1, i), vertex(j + 1, i + 1));
    }
  for (const int j : {0, n_span}) {
    const auto add_cap = [&](VertexId a, VertexId b, VertexId c) { j == 0 ? add(a, b, c) : add(a, c, b); };
    for (int i = 0; i < n / 2; ++i) {  // upper vertex i over lower vertex -i
      if (i > 0) add_cap(vertex(j, i), vertex(j, -i - 1), vertex(j, -i));
      if (vertex(j, i + 1) != vertex(j, -i - 1)) add_cap(vertex(j, i), vertex(j, i + 1), vertex(j, -i - 1));
    }
  }
  return mesh;
}

/// The same wing without its cap at y = 0, where it is open (half of a wing of twice the span), or without both caps.
inline TriMesh open_sharp_wing(double wedge_angle, int n_span, bool is_open_at_both) {
  const TriMesh wall = sharp_wing(wedge_angle, n_span);
  TriMesh open;
  open.points = wall.points;
  open.patches = wall.patches;
  for (const TriangleId t : wall.triangles.ids()) {
    const auto [a, b, c] = corners(wall, t);
    if (a.y == b.y && b.y == c.y && (is_open_at_both || a.y == 0.0)) continue;
    open.triangles.push_back(wall.triangles[t]);
    open.triangle_patch.push_back(wall.triangle_patch[t]);
  }
  return open;
}
inline TriMesh half_sharp_wing(double wedge_angle, int n_span) { return open_sharp_wing(wedge_angle, n_span, false); }

}  // namespace sterna::volmesh
