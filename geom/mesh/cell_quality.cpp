#include "geom/mesh/cell_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/math/constants.h"
#include "geom/math/measures.h"

namespace sterna {
namespace {

/// A corner and the ends of its three edges, so that the triple product is positive.
struct CornerEdges {
  std::uint8_t at, a, b, c;
};
constexpr std::array<CornerEdges, 4> k_pyramid = {{{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
constexpr std::array<CornerEdges, 6> k_prism = {{{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
constexpr std::array<CornerEdges, 8> k_hexahedron = {
    {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};

double triple(const Vec3& a, const Vec3& b, const Vec3& c) { return dot(a, cross(b, c)); }

double over_lengths(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double lengths = norm(a) * norm(b) * norm(c);
  return lengths > 0.0 ? triple(a, b, c) / lengths : 0.0;
}

double least(std::span<const CornerEdges> corners, std::span<const Vec3> p) {
  double least = std::numeric_limits<double>::infinity();
  for (const CornerEdges& corner : corners)
    least = std::min(least, over_lengths(p[corner.a] - p[corner.at], p[corner.b] - p[corner.at], p[corner.c] - p[corner.at]));
  return least;
}

double of_tetrahedron(std::span<const Vec3> p) {
  double longest = 0.0;
  for (std::size_t k = 0; k < 4; ++k)
    longest = std::max(longest, distance(p[k], p[(k + 1) % 4]) * distance(p[k], p[(k + 2) % 4]) * distance(p[k], p[(k + 3) % 4]));
  return longest > 0.0 ? std::numbers::sqrt2 * triple(p[1] - p[0], p[2] - p[0], p[3] - p[0]) / longest : 0.0;
}

double of_hexahedron(std::span<const Vec3> p) {
  const Vec3 x = p[1] + p[2] + p[5] + p[6] - p[0] - p[3] - p[4] - p[7], y = p[2] + p[3] + p[6] + p[7] - p[0] - p[1] - p[4] - p[5],
             z = p[4] + p[5] + p[6] + p[7] - p[0] - p[1] - p[2] - p[3];
  return std::min(least(k_hexahedron, p), over_lengths(x, y, z));
}

template <std::size_t N>
std::array<Vec3, N> corners(std::span<const Vec3> p) {
  std::array<Vec3, N> all;
  std::copy_n(p.begin(), N, all.begin());
  return all;
}

}  // namespace

double scaled_jacobian(CellKind kind, std::span<const Vec3> p) {
  switch (kind) {
    case CellKind::tetrahedron: return of_tetrahedron(p);
    case CellKind::pyramid: return std::numbers::sqrt2 * least(k_pyramid, p);
    case CellKind::prism: return 2.0 / std::numbers::sqrt3 * least(k_prism, p);
    case CellKind::hexahedron: break;
  }
  return of_hexahedron(p);
}

CellQuality cell_quality(CellKind kind, std::span<const Vec3> p) {
  CellQuality quality{scaled_jacobian(kind, p), 0.0, k_nan, k_nan};
  switch (kind) {
    case CellKind::tetrahedron: {
      quality.volume = tet_volume(p[0], p[1], p[2], p[3]);
      const auto range = tet_dihedral_range(corners<4>(p));
      quality.min_dihedral = range[0];
      quality.max_dihedral = range[1];
      break;
    }
    case CellKind::pyramid: quality.volume = pyramid_volume(corners<5>(p)); break;
    case CellKind::prism: quality.volume = wedge_volume(corners<6>(p)); break;
    case CellKind::hexahedron: quality.volume = hexahedron_volume(corners<8>(p)); break;
  }
  return quality;
}

}  // namespace sterna
