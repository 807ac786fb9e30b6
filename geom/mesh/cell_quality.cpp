#include "geom/mesh/cell_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/cell_shapes.h"

namespace sterna {
namespace {

/// A corner and the ends of its three edges, ordered for a positive triple product.
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

// ---- OpenFOAM's centres and measures (cell_shapes.h) ------------------------------------------------------------------------

namespace sterna::check_parts {
namespace {

double reach(std::span<const Point> corners, const Point& centre, const Vec3& direction, double least) {
  double reach = least;
  for (const Point& p : corners) reach = std::max(reach, std::abs(dot(direction, p - centre)));
  return reach;
}

/// Returns the distance between a face's centre and the line from a cell's centre along d, divided by the extent of the face.
double skewness_of(const FaceShape& face, std::span<const Point> corners, const Point& cell, const Vec3& d, double share) {
  const Vec3 to_face = face.centre - cell;
  const Vec3 miss = to_face - (dot(face.area, to_face) / (dot(face.area, d) + k_tiny)) * d;
  const double length = norm(miss);
  return length / reach(corners, face.centre, miss / (length + k_tiny), share * norm(d) + k_tiny);
}

/// Returns OpenFOAM's quality of a tet: its signed volume over that of the regular tet in the same circumsphere.
double tet_quality(const Point& p, const Point& q, const Point& r, const Point& s) {
  const Vec3 a = q - p, b = r - p, c = s - p;
  const double six_volumes = dot(cross(a, b), c);
  const Vec3 to_centre = norm2(c) * cross(a, b) + norm2(b) * cross(c, a) + norm2(a) * cross(b, c);
  const double radius = std::abs(six_volumes) < k_tiny ? k_great : std::min(k_great, norm(to_centre) / (2.0 * std::abs(six_volumes)));
  return six_volumes / 6.0 / (8.0 / (9.0 * std::numbers::sqrt3) * radius * radius * radius + k_tiny);
}

/// Returns the worst quality of the tets formed by the face's edges, its centre and a cell's centre on the side `sign` (1: side of the face normal).
double worst_around_centre(const FaceShape& face, std::span<const Point> corners, const Point& cell, double sign) {
  double worst = 1.0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    worst = std::min(worst, sign * tet_quality(corners[k], corners[(k + 1) % corners.size()], face.centre, cell));
  return worst;
}

/// Returns the worse quality of the two tets formed by a quadrilateral cut at corner `base` and a cell's centre.
double worst_from_corner(std::span<const Point> corners, std::size_t base, const Point& cell, double sign) {
  const auto corner = [&](std::size_t k) { return corners[(base + k) % 4]; };
  return std::min(sign * tet_quality(corner(0), corner(1), corner(2), cell), sign * tet_quality(corner(0), corner(2), corner(3), cell));
}

}  // namespace

double exact_face_tet_quality(const FaceShape& face, std::span<const Point> corners, const Point& cell, const Point* other) {
  double worst = worst_around_centre(face, corners, cell, -1.0);
  if (other != nullptr) worst = std::min(worst, worst_around_centre(face, corners, *other, 1.0));
  if (corners.size() == 3) return worst;
  double best = -k_great;
  for (std::size_t base = 0; base < 2; ++base) {  // the opposite corner gives the same cut
    double cut = worst_from_corner(corners, base, cell, -1.0);
    if (other != nullptr) cut = std::min(cut, worst_from_corner(corners, base, *other, 1.0));
    best = std::max(best, cut);
  }
  return std::min(worst, best);
}

namespace {

/// Powers for the tets at one cell's centre: V^8 / N^6 with V six times the volume and N tet_quality's `to_centre`; negative if a tet is inverted.
struct TetPowers {
  double around = k_great;        ///< least power of the tets formed with the face's centre
  double cuts[2] = {-1.0, -1.0};  ///< least power of the tets of each cut of a quadrilateral
};

/// Computes the powers. Cross products of neighbouring corners are used for all tets. `sign` has the opposite sense of that in worst_around_centre.
TetPowers tet_powers(const FaceShape& face, std::span<const Point> corners, const Point& cell, double sign) {
  std::array<Vec3, 4> a, side, to_centre;  // from the cell's centre: the corners, their cross products with the next corner, and those with the face's centre
  std::array<double, 4> a2;
  const std::size_t n = corners.size();
  const Vec3 c = face.centre - cell;
  const double c2 = norm2(c);
  for (std::size_t k = 0; k < n; ++k) {
    a[k] = corners[k] - cell;
    a2[k] = norm2(a[k]);
    to_centre[k] = cross(c, a[k]);
  }
  const auto power = [](double volume, const Vec3& normal) {
    if (!(volume > 0.0)) return -1.0;
    const double share = 1.0 / norm2(normal), squared = volume * volume, first = squared * squared * share;
    return first * first * share;
  };
  TetPowers powers;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t next = k + 1 < n ? k + 1 : 0;
    side[k] = cross(a[k], a[next]);
    powers.around = std::min(powers.around, power(sign * dot(side[k], c), c2 * side[k] + a2[next] * to_centre[k] - a2[k] * to_centre[next]));
  }
  if (n != 4) return powers;
  for (std::size_t base = 0; base < 2; ++base) {
    const std::size_t next = base + 1, across = base + 2, last = (base + 3) % 4;
    const Vec3 diagonal = cross(a[base], a[across]);
    powers.cuts[base] = std::min(power(sign * dot(side[base], a[across]), a2[across] * side[base] - a2[next] * diagonal + a2[base] * side[next]),
                                 power(sign * dot(side[across], a[base]), a2[base] * side[across] + a2[across] * side[last] + a2[last] * diagonal));
  }
  return powers;
}

/// Returns exact_face_tet_quality() at a third of its cost if all tets are positive: the quality of a tet is 1.5 sqrt(3) V^4 / N^3.
double face_tet_quality(const FaceShape& face, std::span<const Point> corners, const Point& cell, const Point* other) {
  TetPowers powers = tet_powers(face, corners, cell, 1.0);
  if (other != nullptr) {
    const TetPowers more = tet_powers(face, corners, *other, -1.0);
    powers.around = std::min(powers.around, more.around);
    for (std::size_t base = 0; base < 2; ++base) powers.cuts[base] = std::min(powers.cuts[base], more.cuts[base]);
  }
  const double least = corners.size() == 4 ? std::min(powers.around, std::max(powers.cuts[0], powers.cuts[1])) : powers.around;
  return least > k_least_power ? 1.5 * std::numbers::sqrt3 * std::sqrt(least) : exact_face_tet_quality(face, corners, cell, other);
}

}  // namespace

InnerFace inner_face(std::span<const Point> corners, const CellCentre& a, const CellCentre& b) {
  const FaceShape face = face_shape(corners);
  const Vec3 d = b.centre - a.centre;
  const double cosine = dot(d, face.area) / (norm(d) * norm(face.area) + k_tiny);
  const double to_a = std::abs(dot(face.area, face.centre - a.centre)), to_b = std::abs(dot(face.area, b.centre - face.centre));
  return {.non_orthogonality = std::acos(std::clamp(cosine, -1.0, 1.0)),
          .skewness = skewness_of(face, corners, a.centre, d, k_inner_reach),
          .weight = std::min(to_a, to_b) / (to_a + to_b + k_tiny),
          .volume_ratio = std::min(a.volume, b.volume) / (std::max(a.volume, b.volume) + k_tiny),
          .flatness = face.flatness,
          .tets = face_tet_quality(face, corners, a.centre, &b.centre)};
}

OuterFace outer_face(std::span<const Point> corners, const CellCentre& cell) {
  const FaceShape face = face_shape(corners);
  const Vec3 normal = face.area / (norm(face.area) + k_tiny);
  return {.skewness = skewness_of(face, corners, cell.centre, dot(normal, face.centre - cell.centre) * normal, k_boundary_reach),
          .flatness = face.flatness,
          .tets = face_tet_quality(face, corners, cell.centre, nullptr)};
}

namespace {

double determinant_of(std::span<const FaceShape> faces, unsigned inner) {
  double mean = 0.0;
  int n = 0;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if ((inner >> f & 1u) != 0) {
      mean += norm(faces[f].area);
      ++n;
    }
  if (n == 0) return 0.0;
  mean /= n;
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if ((inner >> f & 1u) == 0) continue;
    const Vec3 a = faces[f].area / mean;
    xx += a.x * a.x, xy += a.x * a.y, xz += a.x * a.z, yy += a.y * a.y, yz += a.y * a.z, zz += a.z * a.z;
  }
  constexpr double k_of_cube = 8.0;
  return std::abs(xx * yy * zz + xy * yz * xz + xz * xy * yz - xx * yz * yz - xy * xy * zz - xz * yy * xz) / k_of_cube;
}

}  // namespace

FaceShape face_shape(std::span<const Point> corners) {
  if (corners.size() == 3) return {0.5 * cross(corners[1] - corners[0], corners[2] - corners[0]), (corners[0] + corners[1] + corners[2]) / 3.0, 1.0};
  const Point middle = (corners[0] + corners[1] + corners[2] + corners[3]) * 0.25;
  Vec3 normal{}, weighted{};
  double total = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Point &p = corners[k], &next = corners[(k + 1) % 4];
    const Vec3 twice_area = cross(next - p, middle - p);
    const double size = norm(twice_area);
    normal = normal + twice_area;
    total += size;
    weighted = weighted + size * (p + next + middle);
  }
  if (!(total > 0.0)) return {Vec3{}, middle, 1.0};
  const Point centre = weighted / (3.0 * total);
  double about_centre = 0.0;
  for (std::size_t k = 0; k < 4; ++k) about_centre += norm(cross(corners[(k + 1) % 4] - corners[k], centre - corners[k]));
  return {0.5 * normal, centre, norm(normal) / (about_centre + k_tiny)};
}

CellShape cell_shape(const HybridMesh& mesh, const Cell& cell, unsigned inner) {
  std::array<FaceShape, 6> faces;
  const auto local = cell_faces(cell.kind);
  Point guess{};
  for (std::size_t f = 0; f < local.size(); ++f) {
    std::array<Point, 4> corners;
    for (std::size_t k = 0; k < local[f].size; ++k) corners[k] = mesh.points[cell.nodes[local[f].nodes[k]]];
    faces[f] = face_shape({corners.data(), local[f].size});
    guess = guess + faces[f].centre;
  }
  guess = guess / static_cast<double>(local.size());
  CellShape shape;
  Vec3 weighted{}, sum{}, sizes{};
  double total = 0.0, area = 0.0;
  for (std::size_t f = 0; f < local.size(); ++f) {
    const FaceShape& face = faces[f];
    const double pyramid = dot(face.area, face.centre - guess);
    weighted = weighted + pyramid * (0.75 * face.centre + 0.25 * guess);
    total += pyramid;
    sum = sum + face.area;
    sizes = sizes + Vec3{std::abs(face.area.x), std::abs(face.area.y), std::abs(face.area.z)};
  }
  shape.centre = std::abs(total) > 0.0 ? weighted / total : guess;
  shape.volume = total / 3.0;
  const auto [low, high] = std::minmax({sizes.x, sizes.y, sizes.z});
  area = sizes.x + sizes.y + sizes.z;
  shape.aspect_ratio = std::max(high / (low + k_tiny), area / 6.0 / std::cbrt(shape.volume * shape.volume));
  shape.openness = std::max({std::abs(sum.x) / (sizes.x + k_tiny), std::abs(sum.y) / (sizes.y + k_tiny), std::abs(sum.z) / (sizes.z + k_tiny)});
  shape.determinant = determinant_of({faces.data(), local.size()}, inner);
  return shape;
}

}  // namespace sterna::check_parts
