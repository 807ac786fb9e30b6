// Initial tetrahedral meshes for the tests of the kernel.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "geom/math/predicates.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::test {

struct TetSoup {
  std::vector<Vec3> points;
  std::vector<tets::Corners> tetrahedra;
};

/// Returns the unit cube as n^3 cells of six tetrahedra around a diagonal (Kuhn). Cells for which `is_left_out` returns true are left out, and so are points
/// that only such cells use.
inline TetSoup cube_of_tets(std::uint32_t n, const std::function<bool(const Vec3&)>& is_left_out = {}) {
  TetSoup soup;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbers;
  const auto number = [&](std::array<std::uint32_t, 3> at) {
    const auto [it, is_new] = numbers.try_emplace(at, static_cast<std::uint32_t>(soup.points.size()));
    if (is_new) soup.points.push_back(Vec3{1.0 * at[0], 1.0 * at[1], 1.0 * at[2]} / n);
    return it->second;
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      for (std::uint32_t k = 0; k < n; ++k) {
        if (is_left_out && is_left_out(Vec3{i + 0.5, j + 0.5, k + 0.5} / n)) continue;
        std::array<std::size_t, 3> axes = {0, 1, 2};
        do {
          std::array<std::uint32_t, 3> at = {i, j, k};
          tets::Corners tet{};
          tet[0] = number(at);
          for (std::size_t step = 0; step < 3; ++step) {
            ++at[axes[step]];
            tet[step + 1] = number(at);
          }
          if (orient3d(soup.points[tet[0]], soup.points[tet[1]], soup.points[tet[2]], soup.points[tet[3]]) < 0) std::swap(tet[0], tet[1]);
          soup.tetrahedra.push_back(tet);
        } while (std::ranges::next_permutation(axes).found);
      }
    }
  }
  return soup;
}

inline double volume_of(const tets::TetMesh& mesh) {
  double sum = 0.0;
  for (std::uint32_t t = 0; t < mesh.nodes.size(); ++t) {
    if (!mesh.is_alive(t)) continue;
    const auto p = [&](std::size_t k) { return mesh.points[mesh.nodes[t][k]]; };
    sum += dot(cross(p(1) - p(0), p(2) - p(0)), p(3) - p(0)) / 6.0;
  }
  return sum;
}

/// Returns the triangles without a tetrahedron behind them, lowest corner first, orientation kept. They are stored as coordinates, independent of numbering.
inline std::set<std::array<std::array<double, 3>, 3>> boundary_of(const tets::TetMesh& mesh) {
  std::set<std::array<std::array<double, 3>, 3>> faces;
  for (std::uint32_t t = 0; t < mesh.nodes.size(); ++t) {
    for (std::size_t i = 0; mesh.is_alive(t) && i < 4; ++i) {
      if (mesh.neighbours[t][i] != k_none) continue;
      std::array<std::array<double, 3>, 3> face;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = mesh.points[mesh.nodes[t][tets::k_face[i][k]]];
        face[k] = {p.x, p.y, p.z};
      }
      std::rotate(face.begin(), std::ranges::min_element(face), face.end());
      faces.insert(face);
    }
  }
  return faces;
}

/// Returns true if all tetrahedra are positive and neighbours refer to each other.
inline bool is_sound(const tets::TetMesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.nodes.size(); ++t) {
    if (!mesh.is_alive(t)) continue;
    const tets::Corners& v = mesh.nodes[t];
    if (orient3d(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]) <= 0) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t n = mesh.neighbours[t][i];
      if (n == k_none) continue;
      if (!mesh.is_alive(n / 4) || mesh.neighbours[n / 4][n % 4] != 4 * t + i) return false;
      std::set<std::uint32_t> mine, others;
      for (std::size_t k = 0; k < 3; ++k) {
        mine.insert(v[tets::k_face[i][k]]);
        others.insert(mesh.nodes[n / 4][tets::k_face[n % 4][k]]);
      }
      if (mine != others) return false;
    }
  }
  return true;
}

}  // namespace sterna::test
