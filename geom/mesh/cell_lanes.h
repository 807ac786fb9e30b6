// The formulas of cell_quality.cpp for four faces or cells at a time, with the same rounding except for the angle. Private to the *.cpp files of geom/mesh.
#pragma once

#include <array>
#include <numbers>
#include <span>

#include "geom/mesh/cell_shapes.h"
#include "geom/mesh/lanes.h"

namespace sterna::lanes {

struct FaceShapes {
  Vec3x4 area, centre;
  Packed flatness;
};

struct CellCentres {
  Vec3x4 centre;
  Packed volume;
};

struct CellShapes {
  CellCentres location;
  Packed aspect_ratio, openness, determinant;
};

struct InnerFaces {
  Packed non_orthogonality, skewness, weight, volume_ratio, flatness, tets;
};

inline Vec3 lane(const Vec3x4& v, std::size_t k) { return {v.x[k], v.y[k], v.z[k]}; }
inline void set_lane(Vec3x4& v, std::size_t k, const Vec3& value) { v.x[k] = value.x, v.y[k] = value.y, v.z[k] = value.z; }
inline check_parts::CellCentre lane(const CellCentres& p, std::size_t k) { return {lane(p.centre, k), p.volume[k]}; }
/// Loads four consecutive entries from memory.
inline CellCentres load(const check_parts::CellCentre* at) {
  static_assert(sizeof(check_parts::CellCentre) == 4 * sizeof(double));
  const auto* values = reinterpret_cast<const double*>(at);
  const Packed a = _mm256_loadu_pd(values), b = _mm256_loadu_pd(values + 4), c = _mm256_loadu_pd(values + 8), d = _mm256_loadu_pd(values + 12);
  const Packed ab_low = _mm256_unpacklo_pd(a, b), ab_high = _mm256_unpackhi_pd(a, b), cd_low = _mm256_unpacklo_pd(c, d), cd_high = _mm256_unpackhi_pd(c, d);
  return {{_mm256_permute2f128_pd(ab_low, cd_low, 0x20), _mm256_permute2f128_pd(ab_high, cd_high, 0x20), _mm256_permute2f128_pd(ab_low, cd_low, 0x31)},
          _mm256_permute2f128_pd(ab_high, cd_high, 0x31)};
}

inline FaceShapes face_shapes(const std::array<Vec3x4, 3>& corners) {
  return {0.5 * cross(corners[1] - corners[0], corners[2] - corners[0]), (corners[0] + corners[1] + corners[2]) / all(3.0), all(1.0)};
}

inline FaceShapes face_shapes(const std::array<Vec3x4, 4>& corners) {
  const Vec3x4 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  Vec3x4 normal{}, weighted{};
  Packed total = all(0.0);
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3x4 &p = corners[k], &next = corners[(k + 1) % 4];
    const Vec3x4 twice_area = cross(next - p, middle - p);
    const Packed size = norm(twice_area);
    normal = normal + twice_area;
    total += size;
    weighted = weighted + size * (p + next + middle);
  }
  const Vec3x4 centre = weighted / (3.0 * total);
  Packed about_centre = all(0.0);
  for (std::size_t k = 0; k < 4; ++k) about_centre += norm(cross(corners[(k + 1) % 4] - corners[k], centre - corners[k]));
  const auto has_area = total > all(0.0);
  const auto where = [&](Packed a, Packed b) { return has_area ? a : b; };
  const Packed zero = all(0.0);
  return {{where(0.5 * normal.x, zero), where(0.5 * normal.y, zero), where(0.5 * normal.z, zero)},
          {where(centre.x, middle.x), where(centre.y, middle.y), where(centre.z, middle.z)},
          where(norm(normal) / (about_centre + check_parts::k_tiny), all(1.0))};
}

/// Returns determinants for cells whose faces are all inner faces; other cells need cell_shape().
template <std::size_t N>
Packed determinants(const std::array<FaceShapes, N>& faces) {
  Packed mean = all(0.0);
  for (const FaceShapes& face : faces) mean += norm(face.area);
  mean /= all(static_cast<double>(N));
  Packed xx = all(0.0), xy = xx, xz = xx, yy = xx, yz = xx, zz = xx;
  for (const FaceShapes& face : faces) {
    const Vec3x4 a = face.area / mean;
    xx += a.x * a.x, xy += a.x * a.y, xz += a.x * a.z, yy += a.y * a.y, yz += a.y * a.z, zz += a.z * a.z;
  }
  constexpr double k_of_cube = 8.0;
  return magnitude(xx * yy * zz + xy * yz * xz + xz * xy * yz - xx * yz * yz - xy * xy * zz - xz * yy * xz) / all(k_of_cube);
}

/// Returns area / 6 over volume^(2/3) if the value may be above `least`; else any value below `least`.
inline Packed cube_ratio(Packed area, Packed volume, Packed least) {
  const Packed sixth = area / all(6.0), squared = volume * volume;
  // Comparing cubes decides, except within their rounding, and except for values that underflow or overflow.
  const Packed cubed = sixth * sixth * sixth, bound = least * least * least * squared;
  const auto is_below = (cubed < 0.999999 * bound) & (cubed > all(1e-290)) & (bound < all(1e290));
  Packed ratio = all(0.0);
  for (std::size_t k = 0; k < k_width; ++k)
    if (!is_below[k]) ratio[k] = sixth[k] / std::cbrt(squared[k]);
  return ratio;
}

/// Sums over the faces of a cell.
struct CellSums {
  CellCentres location;
  Vec3x4 area, sizes;
};

template <std::size_t N>
CellSums cell_sums(const std::array<FaceShapes, N>& faces) {
  Vec3x4 guess{};
  for (const FaceShapes& face : faces) guess = guess + face.centre;
  guess = guess / all(static_cast<double>(N));
  Vec3x4 weighted{};
  CellSums sums{};
  Packed total = all(0.0);
  for (const FaceShapes& face : faces) {
    const Packed pyramid = dot(face.area, face.centre - guess);
    weighted = weighted + pyramid * (0.75 * face.centre + 0.25 * guess);
    total += pyramid;
    sums.area = sums.area + face.area;
    sums.sizes = sums.sizes + Vec3x4{magnitude(face.area.x), magnitude(face.area.y), magnitude(face.area.z)};
  }
  const auto has_volume = magnitude(total) > all(0.0);
  const Vec3x4 centre = weighted / total;
  sums.location.centre = {has_volume ? centre.x : guess.x, has_volume ? centre.y : guess.y, has_volume ? centre.z : guess.z};
  sums.location.volume = total / all(3.0);
  return sums;
}

template <std::size_t N>
CellCentres cell_locations(const std::array<FaceShapes, N>& faces) {
  return cell_sums(faces).location;
}

template <std::size_t N>
CellShapes cell_shapes(const std::array<FaceShapes, N>& faces) {
  const auto [location, area, sizes] = cell_sums(faces);
  CellShapes shapes;
  shapes.location = location;
  const Packed low = least(least(sizes.x, sizes.y), sizes.z), high = most(most(sizes.x, sizes.y), sizes.z);
  const Packed by_axes = high / (low + check_parts::k_tiny);
  shapes.aspect_ratio = most(by_axes, cube_ratio(sizes.x + sizes.y + sizes.z, location.volume, by_axes));
  shapes.openness = most(most(magnitude(area.x) / (sizes.x + check_parts::k_tiny), magnitude(area.y) / (sizes.y + check_parts::k_tiny)),
                         magnitude(area.z) / (sizes.z + check_parts::k_tiny));
  shapes.determinant = determinants(faces);
  return shapes;
}

/// Powers of the tets at the centres of four cells (cell_quality.cpp, TetPowers).
struct TetPowers {
  Packed around;
  std::array<Packed, 2> cuts;
};

template <std::size_t N>
TetPowers tet_powers(const FaceShapes& face, const std::array<Vec3x4, N>& corners, const Vec3x4& cell, double sign) {
  std::array<Vec3x4, N> a, side, to_centre;
  std::array<Packed, N> a2;
  const Vec3x4 c = face.centre - cell;
  const Packed c2 = dot(c, c);
  for (std::size_t k = 0; k < N; ++k) {
    a[k] = corners[k] - cell;
    a2[k] = dot(a[k], a[k]);
    to_centre[k] = cross(c, a[k]);
  }
  const auto power = [](Packed volume, const Vec3x4& normal) {
    const Packed share = all(1.0) / dot(normal, normal), squared = volume * volume, first = squared * squared * share;
    return volume > all(0.0) ? first * first * share : all(-1.0);
  };
  TetPowers powers{all(check_parts::k_great), {all(-1.0), all(-1.0)}};
  for (std::size_t k = 0; k < N; ++k) {
    const std::size_t next = k + 1 < N ? k + 1 : 0;
    side[k] = cross(a[k], a[next]);
    powers.around = least(power(sign * dot(side[k], c), c2 * side[k] + a2[next] * to_centre[k] - a2[k] * to_centre[next]), powers.around);
  }
  if constexpr (N == 4) {
    for (std::size_t base = 0; base < 2; ++base) {
      const std::size_t next = base + 1, across = base + 2, last = (base + 3) % 4;
      const Vec3x4 diagonal = cross(a[base], a[across]);
      const Packed first = power(sign * dot(side[base], a[across]), a2[across] * side[base] - a2[next] * diagonal + a2[base] * side[next]);
      const Packed second = power(sign * dot(side[across], a[base]), a2[base] * side[across] + a2[across] * side[last] + a2[last] * diagonal);
      powers.cuts[base] = least(second, first);
    }
  }
  return powers;
}

/// \param n_used number of valid lanes; the other lanes may hold any values
template <std::size_t N>
InnerFaces inner_faces(const std::array<Vec3x4, N>& corners, const FaceShapes& face, const CellCentres& a, const CellCentres& b, std::size_t n_used) {
  using check_parts::k_tiny;
  InnerFaces result;
  const Vec3x4 d = b.centre - a.centre;
  const Packed between = norm(d);
  const Packed cosine = dot(d, face.area) / (between * norm(face.area) + k_tiny);
  result.non_orthogonality = arc_cosine(most(all(-1.0), least(all(1.0), cosine)));
  const Vec3x4 to_face = face.centre - a.centre;
  const Packed from_a = dot(face.area, to_face);
  const Vec3x4 miss = to_face - (from_a / (dot(face.area, d) + k_tiny)) * d;
  const Packed length = norm(miss);
  const Vec3x4 direction = miss / (length + k_tiny);
  Packed reach = check_parts::k_inner_reach * between + k_tiny;
  for (const Vec3x4& p : corners) reach = most(magnitude(dot(direction, p - face.centre)), reach);
  result.skewness = length / reach;
  const Packed to_a = magnitude(from_a), to_b = magnitude(dot(face.area, b.centre - face.centre));
  result.weight = least(to_a, to_b) / (to_a + to_b + k_tiny);
  result.volume_ratio = least(a.volume, b.volume) / (most(a.volume, b.volume) + k_tiny);
  result.flatness = face.flatness;

  const TetPowers here = tet_powers(face, corners, a.centre, 1.0), there = tet_powers(face, corners, b.centre, -1.0);
  Packed lowest = least(here.around, there.around);
  if constexpr (N == 4) lowest = least(lowest, most(least(here.cuts[0], there.cuts[0]), least(here.cuts[1], there.cuts[1])));
  result.tets = (1.5 * std::numbers::sqrt3) * root(lowest);
  const auto is_sure = lowest > all(check_parts::k_least_power);
  for (std::size_t k = 0; k < n_used; ++k) {
    if (is_sure[k]) continue;
    std::array<Point, N> points;
    for (std::size_t i = 0; i < N; ++i) points[i] = lane(corners[i], k);
    const Point other = lane(b.centre, k);
    result.tets[k] = check_parts::exact_face_tet_quality({lane(face.area, k), lane(face.centre, k), face.flatness[k]}, points, lane(a.centre, k), &other);
  }
  return result;
}

}  // namespace sterna::lanes
