#include "geom/math/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/geom/math/exact_reference.h"

namespace sterna {
namespace {

using test::BigRational;

// ---------------------------------------------------------------- reference for wedges: values of the Jacobian itself, in rational numbers

using RationalVector = std::array<BigRational, 3>;
RationalVector vector(const Vec3& from, const Vec3& to) {
  return {BigRational(to.x) - BigRational(from.x), BigRational(to.y) - BigRational(from.y), BigRational(to.z) - BigRational(from.z)};
}
RationalVector blend(const RationalVector& a, const RationalVector& b, const BigRational& z) {
  RationalVector result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = (1 - z) * a[i] + z * b[i];
  return result;
}
BigRational determinant(const RationalVector& a, const RationalVector& b, const RationalVector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}
/// Returns the Jacobian of the trilinear map at height z over corner k.
BigRational jacobian(const WedgePoints& p, std::size_t k, const BigRational& z) {
  return determinant(blend(vector(p[0], p[1]), vector(p[3], p[4]), z), blend(vector(p[0], p[2]), vector(p[3], p[5]), z), vector(p[k], p[k + 3]));
}
/// Literal implementation of docs/method/validity.md, "Exact wedge test".
bool reference_is_valid(const WedgePoints& p) {
  for (std::size_t k = 0; k < 3; ++k) {
    const BigRational b0 = jacobian(p, k, 0), b2 = jacobian(p, k, 1);
    const BigRational b1 = 2 * jacobian(p, k, BigRational(1, 2)) - (b0 + b2) / 2;
    if (b0 <= 0 || b2 <= 0 || (b1 < 0 && b1 * b1 >= b0 * b2)) return false;
  }
  return true;
}
double reference_volume(const WedgePoints& p) {
  // Simpson's rule is exact for a quadratic; the mean over the triangle is the mean of its corners for a linear function.
  BigRational sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += jacobian(p, k, 0) + 4 * jacobian(p, k, BigRational(1, 2)) + jacobian(p, k, 1);
  return static_cast<double>(BigRational(sum / 36));
}

/// Orders of the corners that keep the wedge: rotations of the triangle, and upside down.
std::vector<WedgePoints> same_wedges(const WedgePoints& p) {
  return {p, {p[1], p[2], p[0], p[4], p[5], p[3]}, {p[2], p[0], p[1], p[5], p[3], p[4]}, {p[3], p[5], p[4], p[0], p[2], p[1]}};
}
WedgePoints inside_out(const WedgePoints& p) { return {p[0], p[2], p[1], p[3], p[5], p[4]}; }

template <std::size_t N, class F>
std::array<Vec3, N> mapped(const std::array<Vec3, N>& p, const F& f) {
  std::array<Vec3, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = f(p[i]);
  return result;
}

/// Returns a wedge with base edges (1, 0), (0, 1) and the given top edges a and b, rotated and stretched against the base.
WedgePoints with_top(double ax, double ay, double bx, double by, double height) {
  return {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, height}, {ax, ay, height}, {bx, by, height}};
}

const WedgePoints k_right = with_top(1, 0, 0, 1, 1);

TEST(Wedge, RightWedgeHasItsVolumeAndQuality) {
  EXPECT_DOUBLE_EQ(wedge_volume(k_right), 0.5);
  EXPECT_DOUBLE_EQ(wedge_quality(k_right), std::sqrt(0.5));  // the 45 degree corners
  for (const WedgePoints& p : same_wedges(k_right)) {
    EXPECT_TRUE(is_wedge_valid(p));
    EXPECT_FALSE(is_wedge_valid(inside_out(p)));
    EXPECT_DOUBLE_EQ(wedge_volume(inside_out(p)), -0.5);
    EXPECT_LT(wedge_quality(inside_out(p)), 0.0);
  }
}

TEST(Wedge, InvertedInsideThoughAllCornerJacobiansArePositive) {
  // Top edges -2 a and -b/2: b0 = b2 = 1, b1 = -(1/2 + 2)/2 = -5/4.
  const WedgePoints p = with_top(-2, 0, 0, -0.5, 1);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GT(jacobian(p, k, 0), 0);
    EXPECT_GT(jacobian(p, k, 1), 0);
    EXPECT_LT(jacobian(p, k, BigRational(1, 2)), 0);
  }
  for (const WedgePoints& q : same_wedges(p)) {
    EXPECT_FALSE(is_wedge_valid(q));
    EXPECT_LT(wedge_quality(q), 0.0);
  }
}

TEST(Wedge, TwistedWedgeIsValidUpToHalfTurn) {
  // b0 = b2 = 1, b1 = cos(angle): positive everywhere below pi; at exactly pi the middle section is a point.
  for (const double angle_deg : {0.0, 45.0, 90.0, 135.0, 179.9}) {
    const double c = std::cos(angle_deg * std::numbers::pi / 180), s = std::sin(angle_deg * std::numbers::pi / 180);
    for (const WedgePoints& q : same_wedges(with_top(c, s, -s, c, 0.5))) {
      EXPECT_TRUE(is_wedge_valid(q)) << angle_deg;
      EXPECT_GT(wedge_quality(q), 0.0) << angle_deg;
    }
  }
  for (const WedgePoints& q : same_wedges(with_top(-1, 0, 0, -1, 0.5))) {
    EXPECT_FALSE(is_wedge_valid(q));
  }
  // One unit in the last place to the valid side of the limit.
  EXPECT_TRUE(reference_is_valid(with_top(-1, 0x1p-53, -0x1p-53, -1, 0.5)));
  EXPECT_TRUE(is_wedge_valid(with_top(-1, 0x1p-53, -0x1p-53, -1, 0.5)));
}

TEST(Wedge, ExactTestKeepsItsRange) {
  for (const double scale : {0x1p-119, 1.0, 0x1p159}) {  // 1e-36 .. 1e48
    const auto scaled = [&](const WedgePoints& p) { return mapped(p, [&](const Vec3& x) { return scale * (x + Vec3{1, 1, 1}); }); };
    for (const double d : {0.0, 0x1p-51, 0x1p-50, 0x1p-40}) {
      const WedgePoints p = scaled(with_top(-0.75, d, -d, -0.75, 0x1p-20));
      EXPECT_EQ(is_wedge_valid(p), reference_is_valid(p)) << scale << " " << d;
      EXPECT_EQ(is_wedge_valid(p), d > 0.0) << scale << " " << d;
    }
  }
}

TEST(Wedge, CoordinatesThatAreNotFiniteAreInvalid) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
    for (std::size_t i = 0; i < 18; ++i) {
      WedgePoints p = k_right;
      p[i / 3][i % 3] = bad;
      EXPECT_FALSE(is_wedge_valid(p)) << bad << " at " << i;
    }
  }
}

TEST(Wedge, CollapsedWedgesAreInvalid) {
  EXPECT_FALSE(is_wedge_valid(with_top(1, 0, 0, 1, 0)));
  WedgePoints p = k_right;
  p[4] = p[1];
  EXPECT_FALSE(is_wedge_valid(p));
  EXPECT_LE(wedge_quality(p), 0.0);
  p = k_right;
  p[2] = {0.5, 0, 0};
  EXPECT_FALSE(is_wedge_valid(p));
  EXPECT_FALSE(is_wedge_valid(WedgePoints{}));
  EXPECT_EQ(wedge_quality(WedgePoints{}), 0.0);
}

TEST(Wedge, MatchesRationalTestOnIntegersMovedAndScaled) {
  std::mt19937_64 random(31);
  std::uniform_int_distribution<int> coordinate(-2, 2);
  int n_valid = 0, n_middle = 0;
  for (int n = 0; n < 20000; ++n) {
    WedgePoints p;
    for (std::size_t i = 0; i < 6; ++i) p[i] = {double(coordinate(random)), double(coordinate(random)), i < 3 ? 0.0 : double(1 + coordinate(random) / 2)};
    if (n % 2 == 0) p[0] = {0, 0, 0}, p[1] = {2, 0, 0}, p[2] = {0, 2, 0};
    const bool expected = reference_is_valid(p);
    n_valid += expected;
    bool corners_positive = true;
    for (std::size_t k = 0; k < 3; ++k) corners_positive = corners_positive && jacobian(p, k, 0) > 0 && jacobian(p, k, 1) > 0;
    n_middle += corners_positive && !expected;
    for (const WedgePoints& q : same_wedges(p)) {
      ASSERT_EQ(is_wedge_valid(q), expected) << n;
      ASSERT_EQ(is_wedge_valid(mapped(q, [](const Vec3& x) { return 1e6 * x + Vec3{1e3, 1e3, -1e3}; })), expected) << n;
      ASSERT_EQ(is_wedge_valid(mapped(q, [](const Vec3& x) { return 0x1p-20 * Vec3{x.z, x.x, x.y} + Vec3{1e3, 0, -1e3}; })), expected) << n;
      ASSERT_EQ(is_wedge_valid(inside_out(mapped(q, [](const Vec3& x) { return Vec3{x.y, x.x, x.z}; }))), expected) << n;
    }
  }
  EXPECT_GT(n_valid, 500);
  EXPECT_GT(n_middle, 50);
}

TEST(Wedge, MatchesRationalTestNearTheLimit) {
  // b1^2 = b0 b2 up to rounding: a rotated and stretched top, scaled to meet the determinant condition.
  std::mt19937_64 random(32);
  std::uniform_real_distribution<double> uniform(0.1, 1.0);
  int n_valid = 0;
  for (int n = 0; n < 4000; ++n) {
    // Top edges -s a + d b and -d a - t b: b1^2 - b0 b2 = ((s - t)/2)^2 - d^2, so s = t, d = 0 is the limit.
    const double s = uniform(random), t = n % 2 == 0 ? s : std::nextafter(s, 2.0);
    const double d = std::array{0.0, 1e-30, 4e-17, 7e-17}[static_cast<std::size_t>(n % 4)];
    WedgePoints p = with_top(-s, d, -d, -t, 1e-3 * uniform(random));
    if (n % 7 < 3) {
      p = mapped(p, [&](const Vec3& x) { return Vec3{0.6 * x.x - 0.8 * x.y, 0.8 * x.x + 0.6 * x.y + 0.1 * x.z, x.z + 0.3 * x.x} + Vec3{10.1, -20.2, 3.3}; });
    }
    const bool expected = reference_is_valid(p);
    n_valid += expected;
    for (const WedgePoints& q : same_wedges(p)) ASSERT_EQ(is_wedge_valid(q), expected) << n;
  }
  EXPECT_GT(n_valid, 100);
  EXPECT_LT(n_valid, 3900);
}

/// Returns a first layer cell: edges of about 1, height 1e-6, anywhere within 50 m, in any direction.
WedgePoints flat_wedge(std::mt19937_64& random, double height) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Vec3 corner = 50.0 * Vec3{uniform(random), uniform(random), uniform(random)};
  WedgePoints p;
  Vec3 normal;
  do {
    p[0] = corner;
    p[1] = corner + Vec3{uniform(random), uniform(random), uniform(random)};
    p[2] = corner + Vec3{uniform(random), uniform(random), uniform(random)};
    normal = cross(p[1] - p[0], p[2] - p[0]);
  } while (norm(normal) < 0.2);
  for (std::size_t k = 0; k < 3; ++k) p[k + 3] = p[k] + height * (normalized(normal) + 0.2 * Vec3{uniform(random), uniform(random), uniform(random)});
  return p;
}

TEST(Wedge, FlatWedgesFarFromTheOrigin) {
  std::mt19937_64 random(33);
  for (int n = 0; n < 20000; ++n) ASSERT_TRUE(is_wedge_valid(flat_wedge(random, 1e-6))) << n;
  // Where the height is a few units in the last place of the coordinates, either result is possible, but it must be the exact one.
  int n_valid = 0;
  for (int n = 0; n < 2000; ++n) {
    const WedgePoints p = flat_wedge(random, 4e-15);
    const bool expected = reference_is_valid(p);
    n_valid += expected;
    ASSERT_EQ(is_wedge_valid(p), expected) << n;
  }
  EXPECT_GT(n_valid, 20);
  EXPECT_LT(n_valid, 1980);
}

TEST(Wedge, VolumeOfFlatAndTwistedWedgesIsAccurate) {
  std::mt19937_64 random(34);
  for (const double height : {1.0, 1e-6}) {
    for (int n = 0; n < 300; ++n) {
      const WedgePoints p = flat_wedge(random, height);
      const double expected = reference_volume(p);
      // Error of a few dozen roundings of terms of about height times edge^2, with edges of about 1.
      EXPECT_NEAR(wedge_volume(p), expected, 1e-14 * height);
      // Independent check: the flux through the faces.
      const double flux = dot(p[3] - p[0], cross(p[4] - p[3], p[5] - p[3])) / 6.0 + bilinear_flux(p[0], p[0], p[1], p[4], p[3]) +
                          bilinear_flux(p[0], p[1], p[2], p[5], p[4]) + bilinear_flux(p[0], p[2], p[0], p[3], p[5]);
      EXPECT_NEAR(flux, expected, 1e-14 * height);
    }
  }
}

TEST(Wedge, QualityIsPositiveForValidWedgesOnly) {
  std::mt19937_64 random(35);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int n_valid = 0;
  for (int n = 0; n < 20000; ++n) {
    WedgePoints p;
    for (std::size_t i = 0; i < 6; ++i) p[i] = k_right[i] + 0.9 * Vec3{uniform(random), uniform(random), uniform(random)};
    const bool is_valid = is_wedge_valid(p);
    n_valid += is_valid;
    const double quality = wedge_quality(p);
    EXPECT_LE(quality, 1.0);
    if (std::abs(quality) > 1e-14) {
      EXPECT_EQ(quality > 0.0, is_valid);
    }
    // Scaling, translation and rotation do not change the quality.
    const double other = wedge_quality(mapped(p, [](const Vec3& x) { return 1e-6 * Vec3{x.z, x.x, x.y}; }));
    EXPECT_NEAR(quality, other, 1e-12);
  }
  EXPECT_GT(n_valid, 1000);
  EXPECT_LT(n_valid, 19000);
}

TEST(Tet, RegularAndRightTetrahedra) {
  const std::array<Vec3, 4> regular = {Vec3{1, 1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}};
  for (const double a : tet_dihedral_range(regular)) EXPECT_NEAR(a, std::acos(1.0 / 3.0), 1e-15);
  const std::array<Vec3, 4> right = {Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_NEAR(tet_dihedral_range(right)[0], std::acos(1.0 / std::sqrt(3.0)), 1e-15);
  EXPECT_NEAR(tet_dihedral_range(right)[1], std::numbers::pi / 2, 1e-15);
  EXPECT_TRUE(is_tet_valid(right));
  EXPECT_FALSE(is_tet_valid({right[1], right[0], right[2], right[3]}));
  EXPECT_FALSE(is_tet_valid({right[0], right[1], right[2], Vec3{0.3, 0.3, 0}}));
  EXPECT_DOUBLE_EQ(tet_volume(right[0], right[1], right[2], right[3]), 1.0 / 6.0);
  // A sliver: four points around a circle. At a side edge the two faces are 2 h apart, at distance sqrt(2) from the other corner.
  const auto sliver = tet_dihedral_range({Vec3{1, 0, 1e-8}, {0, 1, 0}, {-1, 0, 1e-8}, {0, -1, 0}});
  EXPECT_NEAR(sliver[0], std::sqrt(2.0) * 1e-8, 1e-14);
  EXPECT_NEAR(sliver[1], std::numbers::pi - 2e-8, 1e-14);
}

TEST(Pyramid, VolumeAndValidity) {
  const std::array<Vec3, 5> right = {Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 3}};
  EXPECT_DOUBLE_EQ(pyramid_volume(right), 1.0);
  EXPECT_TRUE(is_pyramid_valid(right));
  EXPECT_FALSE(is_pyramid_valid({right[0], right[3], right[2], right[1], right[4]}));
  // A non-convex base has a corner where the pyramid is inverted.
  auto dented = right;
  dented[2] = {0.4, 0.4, 0};
  EXPECT_FALSE(is_pyramid_valid(dented));
  dented[2] = {0.5, 0.5, 0};  // the corner is straight
  EXPECT_FALSE(is_pyramid_valid(dented));
  // A warped base: mean of the two splits into tets.
  auto warped = right;
  warped[2].z = 0.5;
  const double one = tet_volume(warped[0], warped[1], warped[2], warped[4]) + tet_volume(warped[0], warped[2], warped[3], warped[4]);
  const double two = tet_volume(warped[0], warped[1], warped[3], warped[4]) + tet_volume(warped[1], warped[2], warped[3], warped[4]);
  EXPECT_NEAR(pyramid_volume(warped), 0.5 * (one + two), 1e-15);
}

TEST(BilinearFlux, MatchesQuadrature) {
  const Vec3 a{0.1, 0.2, 0.3}, b{1.2, -0.1, 0.4}, c{1.0, 1.3, 1.1}, d{-0.2, 0.9, -0.3}, origin{0.3, -0.7, 2.0};
  // Gauss 3 x 3, exact up to degree five; the integrand has degree three in each coordinate.
  const double g = std::sqrt(0.6);
  const double node[3] = {0.5 * (1 - g), 0.5, 0.5 * (1 + g)}, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double u = node[i], v = node[j];
      const Vec3 x = (1 - u) * (1 - v) * a + u * (1 - v) * b + u * v * c + (1 - u) * v * d;
      const Vec3 xu = (1 - v) * (b - a) + v * (c - d), xv = (1 - u) * (d - a) + u * (c - b);
      sum += weight[i] * weight[j] * dot(x - origin, cross(xu, xv)) / 3.0;
    }
  }
  EXPECT_NEAR(bilinear_flux(origin, a, b, c, d), sum, 1e-15);
  EXPECT_NEAR(bilinear_flux(origin, d, c, b, a), -sum, 1e-15);
}

TEST(Hexahedron, VolumeAndValidity) {
  const std::array<Vec3, 8> cube = {Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  EXPECT_DOUBLE_EQ(hexahedron_volume(cube), 1.0);
  EXPECT_TRUE(is_hexahedron_valid(cube));
  EXPECT_FALSE(is_hexahedron_valid({cube[4], cube[5], cube[6], cube[7], cube[0], cube[1], cube[2], cube[3]}));
  // An extremely flat, rotated cell far from the origin.
  EXPECT_TRUE(is_hexahedron_valid(mapped(cube, [](const Vec3& x) { return Vec3{1e-6 * x.z + 0.5 * x.y, 0.7 * x.x, x.y} + Vec3{30, 20, 10}; })));
  auto collapsed = cube;
  collapsed[6] = collapsed[7];
  EXPECT_FALSE(is_hexahedron_valid(collapsed));
  EXPECT_FALSE(is_hexahedron_valid(std::array<Vec3, 8>{}));
  // Twisted by half a turn: all corner Jacobians are positive, but the middle section is a point.
  auto twisted = cube;
  for (std::size_t i = 4; i < 8; ++i) twisted[i] = {1 - cube[i].x, 1 - cube[i].y, 1};
  EXPECT_FALSE(is_hexahedron_valid(twisted));

  // Comparison with sampling: no cell reported as valid has a negative Jacobian, and few valid cells are rejected.
  std::mt19937_64 random(36);
  std::uniform_real_distribution<double> uniform(-0.45, 0.45);
  int n_valid = 0, n_refused = 0;
  for (int n = 0; n < 3000; ++n) {
    auto p = mapped(cube, [&](const Vec3& x) { return x + Vec3{uniform(random), uniform(random), uniform(random)}; });
    double smallest = 1e300;
    constexpr int k_steps = 6;
    for (int i = 0; i <= k_steps; ++i) {
      for (int j = 0; j <= k_steps; ++j) {
        for (int k = 0; k <= k_steps; ++k) {
          const double u = double(i) / k_steps, v = double(j) / k_steps, w = double(k) / k_steps;
          const auto mix = [](double s, const Vec3& a, const Vec3& b) { return (1 - s) * a + s * b; };
          const Vec3 du = mix(w, mix(v, p[1] - p[0], p[2] - p[3]), mix(v, p[5] - p[4], p[6] - p[7]));
          const Vec3 dv = mix(w, mix(u, p[3] - p[0], p[2] - p[1]), mix(u, p[7] - p[4], p[6] - p[5]));
          const Vec3 dw = mix(v, mix(u, p[4] - p[0], p[5] - p[1]), mix(u, p[7] - p[3], p[6] - p[2]));
          smallest = std::min(smallest, dot(du, cross(dv, dw)));
        }
      }
    }
    const bool is_valid = is_hexahedron_valid(p);
    n_valid += is_valid;
    ASSERT_FALSE(is_valid && smallest < -1e-12) << n;
    n_refused += smallest > 0.05 && !is_valid;
    // The volume must not depend on the first corner.
    const auto moved = mapped(p, [](const Vec3& x) { return Vec3{x.z, x.x, x.y} + Vec3{3, 2, 1}; });
    EXPECT_NEAR(hexahedron_volume(p), hexahedron_volume(moved), 1e-13);
  }
  EXPECT_GT(n_valid, 300);
  EXPECT_EQ(n_refused, 0);
}

}  // namespace
}  // namespace sterna
