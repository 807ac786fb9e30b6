// Walls as CAD programs tessellate them: few points on plane faces, many around holes, so that most triangles are slivers (needles).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "geom/mesh/tri_mesh.h"

namespace sterna::test {

/// Returns a plate of n_x x n_y unit squares with a through hole in each. The hole's circle has `n_around` points; its wall is one strip of triangles from top
/// to bottom. On top and bottom each point of the circle is joined to the nearest corner of its square. n_around is a multiple of 4.
inline TriMesh drilled_plate(std::uint32_t n_x, std::uint32_t n_y, std::uint32_t n_around, double thickness, double radius) {
  TriMesh mesh;
  mesh.patches = {{"plate"}};
  const std::uint32_t n_corners = (n_x + 1) * (n_y + 1);
  const auto corner = [&](std::uint32_t i, std::uint32_t j, bool is_top) { return (is_top ? n_corners : 0) + j * (n_x + 1) + i; };
  for (const double z : {0.0, thickness})
    for (std::uint32_t j = 0; j <= n_y; ++j)
      for (std::uint32_t i = 0; i <= n_x; ++i) mesh.points.push_back(Point{1.0 * i, 1.0 * j, z});
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
    mesh.triangle_patch.push_back(PatchId(0));
  };
  const auto side = [&](std::array<std::uint32_t, 2> p, std::array<std::uint32_t, 2> q) {
    const std::uint32_t a = corner(p[0], p[1], false), b = corner(q[0], q[1], false), c = corner(q[0], q[1], true), d = corner(p[0], p[1], true);
    add(a, b, c);
    add(a, c, d);
  };
  for (std::uint32_t j = 0; j < n_y; ++j)
    for (std::uint32_t i = 0; i < n_x; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.points.size());
      for (const double z : {0.0, thickness})
        for (std::uint32_t k = 0; k < n_around; ++k) {
          const double angle = 2.0 * std::numbers::pi * (k + 0.5) / n_around;
          mesh.points.push_back(Point{i + 0.5 + radius * std::cos(angle), j + 0.5 + radius * std::sin(angle), z});
        }
      for (std::uint32_t k = 0; k < n_around; ++k) {
        const std::uint32_t next = (k + 1) % n_around, a = first + k, b = first + next, top_a = a + n_around, top_b = b + n_around;
        const auto nearest = [&](std::uint32_t point, bool is_top) {
          constexpr std::array<std::array<std::uint32_t, 2>, 4> k_corners = {{{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
          const auto& c = k_corners[4 * point / n_around];
          return corner(i + c[0], j + c[1], is_top);
        };
        for (const bool is_top : {true, false}) {
          const std::uint32_t p = is_top ? top_a : a, q = is_top ? top_b : b, of_p = nearest(k, is_top), of_q = nearest(next, is_top);
          if (is_top) add(p, of_p, q);
          else add(p, q, of_p);
          if (of_p == of_q) continue;
          if (is_top) add(q, of_p, of_q);
          else add(q, of_q, of_p);
        }
        add(a, top_b, b);
        add(a, top_a, top_b);
      }
      if (i == 0) side({i, j + 1}, {i, j});
      if (i + 1 == n_x) side({i + 1, j}, {i + 1, j + 1});
      if (j == 0) side({i, j}, {i + 1, j});
      if (j + 1 == n_y) side({i + 1, j + 1}, {i, j + 1});
    }
  return mesh;
}

}  // namespace sterna::test
