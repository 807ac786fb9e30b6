// Measures of tetrahedra and pyramids; wedges are in wedge.cpp, hexahedra in hexahedron.cpp.
#include "geom/math/measures.h"

#include <algorithm>
#include <numbers>

#include "geom/math/predicates.h"

namespace sterna {

std::array<double, 2> tet_dihedral_range(const std::array<Vec3, 4>& p) {
  // Each entry is an edge i-j with the two other vertices k, l: its angle is that between the half-planes through k and l.
  constexpr std::size_t k_edges[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};
  std::array<double, 2> range = {std::numbers::pi, 0.0};
  for (const auto& [i, j, k, l] : k_edges) {
    const Vec3 edge = p[j] - p[i];
    const double angle = angle_between(cross(edge, p[k] - p[i]), cross(edge, p[l] - p[i]));
    range = {std::min(range[0], angle), std::max(range[1], angle)};
  }
  return range;
}

double bilinear_flux(const Vec3& origin, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  // Integral over the unit square of (x - origin) . (x_u x x_v) / 3 with x bilinear, x_u linear in v, x_v linear in u:
  // the products of two linear weights integrate to 1/3 at the same end, 1/6 at opposite ends. It equals the mean of the two
  // triangulations, but uses no diagonal, whose rounding would swamp the area of a very thin quadrilateral.
  const Vec3 u0 = b - a, u1 = c - d;  // x_u at v = 0, 1
  const Vec3 v0 = d - a, v1 = c - b;  // x_v at u = 0, 1
  const Vec3 u_low = 2.0 * u0 + u1, u_high = u0 + 2.0 * u1;
  const Vec3 v_low = 2.0 * v0 + v1, v_high = v0 + 2.0 * v1;
  return (dot(a - origin, cross(u_low, v_low)) + dot(b - origin, cross(u_low, v_high)) + dot(c - origin, cross(u_high, v_high)) +
          dot(d - origin, cross(u_high, v_low))) /
         108.0;
}

bool is_tet_valid(const std::array<Vec3, 4>& p) { return orient3d(p[0], p[1], p[2], p[3]) > 0; }

bool is_pyramid_valid(const std::array<Vec3, 5>& p) {
  for (std::size_t i = 0; i < 4; ++i) {
    if (orient3d(p[i], p[(i + 1) % 4], p[(i + 3) % 4], p[4]) <= 0) return false;
  }
  return true;
}

double pyramid_volume(const std::array<Vec3, 5>& p) {
  // Relative to the apex only the base has a flux; its outward normal is that of 0 3 2 1.
  return bilinear_flux(p[4], p[0], p[3], p[2], p[1]);
}

}  // namespace sterna
