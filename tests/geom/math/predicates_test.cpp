#include "geom/math/predicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/geom/math/exact_reference.h"

namespace sterna {
namespace {

std::vector<double> row(const Vec2& p) { return {p.x, p.y}; }
std::vector<double> row(const Vec3& p) { return {p.x, p.y, p.z}; }

int exact_orient2d(const Vec2& a, const Vec2& b, const Vec2& c) { return test::reference_sign({row(a), row(b), row(c)}, false); }
int exact_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return test::reference_sign({row(a), row(b), row(c), row(d)}, false); }
int exact_incircle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) { return test::reference_sign({row(d), row(a), row(b), row(c)}, true); }
/// Calls f(order, parity) for every order of N items; the parity is +1 or -1.
template <std::size_t N, class F>
void for_all_orders(const F& f) {
  std::array<std::size_t, N> order;
  std::iota(order.begin(), order.end(), std::size_t{0});
  do {
    int parity = 1;
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = i + 1; j < N; ++j) {
        if (order[i] > order[j]) parity = -parity;
      }
    }
    f(order, parity);
  } while (std::next_permutation(order.begin(), order.end()));
}

/// Moves a value by n units in the last place.
double nudge(double x, int n) {
  for (; n > 0; --n) x = std::nextafter(x, 1e300);
  for (; n < 0; ++n) x = std::nextafter(x, -1e300);
  return x;
}

TEST(Predicates, SignsOfHandDerivedCases) {
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orient2d({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orient2d({0, 0}, {1, 1}, {3, 3}), 0);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}), -1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {7, -3, 0}), 0);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}), 1);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {1, 1}), 0);
  EXPECT_EQ(incircle({0, 0}, {1, 0}, {0, 1}, {2, 2}), -1);
}

TEST(Predicates, RepeatedPointsGiveZero) {
  const Vec3 p{0.1, 0.2, 0.3}, q{0.7, -1.3, 2.9}, r{1e6, 1e-6, 3.3};
  EXPECT_EQ(orient3d(p, q, r, p), 0);
  EXPECT_EQ(orient3d(p, q, q, r), 0);
  EXPECT_EQ(orient2d({0.1, 0.3}, {0.7, 1e5}, {0.1, 0.3}), 0);
  EXPECT_EQ(incircle({0.1, 0.3}, {0.7, 1e5}, {3, 4}, {3, 4}), 0);
}

TEST(Predicates, Orient2dMatchesBigIntegersNearLine) {
  // Kettner et al. 2008: a grid of neighbouring doubles around a diagonal, where plain double arithmetic is wrong in half of the cases.
  int n_zero = 0;
  for (int i = -16; i <= 16; ++i) {
    for (int j = -16; j <= 16; ++j) {
      const Vec2 a{nudge(0.5, i), nudge(0.5, j)}, b{12, 12}, c{24, 24};
      const int expected = exact_orient2d(a, b, c);
      n_zero += expected == 0;
      ASSERT_EQ(orient2d(a, b, c), expected) << i << " " << j;
      ASSERT_EQ(orient2d(b, a, c), -expected) << i << " " << j;
    }
  }
  EXPECT_EQ(n_zero, 33);  // the points with x == y
}

TEST(Predicates, Orient3dMatchesBigIntegersNearPlane) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::array<int, 3> count{};
  for (int n = 0; n < 3000; ++n) {
    // d is a rounded combination of a, b, c, then nudged: on the plane up to a few units in the last place; far from the origin for odd n.
    const double offset = n % 2 == 0 ? 0.0 : 1000.0;
    std::array<Vec3, 4> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = {offset + uniform(random), offset + uniform(random), uniform(random)};
    const double s = uniform(random), t = uniform(random);
    p[3] = p[0] + s * (p[1] - p[0]) + t * (p[2] - p[0]);
    p[3].z = nudge(p[3].z, n % 5 - 2);
    if (n % 7 == 0) {
      // Exactly on the plane: coordinates of few bits.
      for (std::size_t i = 0; i < 3; ++i) p[i] = {std::round(16 * p[i].x) / 16, std::round(16 * p[i].y) / 16, std::round(16 * p[i].z) / 16};
      p[3] = p[0] + 2.0 * (p[1] - p[0]) - 3.0 * (p[2] - p[0]);
    }
    const int expected = exact_orient3d(p[0], p[1], p[2], p[3]);
    ++count[static_cast<std::size_t>(expected + 1)];
    for_all_orders<4>([&](const auto& o, int parity) { ASSERT_EQ(orient3d(p[o[0]], p[o[1]], p[o[2]], p[o[3]]), parity * expected) << n; });
  }
  for (const int c : count) EXPECT_GT(c, 300);
}

TEST(Predicates, IncircleMatchesBigIntegersNearACircle) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> angle(0.0, 6.28);
  int n_zero = 0;
  for (int n = 0; n < 2000; ++n) {
    std::array<Vec2, 4> p;
    const double offset = n % 2 == 0 ? 0.0 : 1000.0;
    for (Vec2& q : p) {
      const double a = angle(random);
      q = {offset + std::cos(a), std::sin(a)};
    }
    if (n % 5 == 0) p = {Vec2{0.1, 0.3}, {0.7, 0.3}, {0.7, 1e-3 * n}, {0.1, 1e-3 * n}};  // corners of a rectangle
    const int expected = exact_incircle(p[0], p[1], p[2], p[3]);
    n_zero += expected == 0;
    for_all_orders<4>([&](const auto& o, int parity) { ASSERT_EQ(incircle(p[o[0]], p[o[1]], p[o[2]], p[o[3]]), parity * expected) << n; });
  }
  EXPECT_GE(n_zero, 400);
}

TEST(Predicates, SignsSurviveExactTransformations) {
  // Integer coordinates: moving by 1e3 and scaling by 1e6 or a power of two near 1e-6 are exact, so the signs are those of the integers.
  std::mt19937_64 random(14);
  std::uniform_int_distribution<int> coordinate(-3, 3);
  for (int n = 0; n < 2000; ++n) {
    std::array<Vec3, 4> p;
    for (Vec3& q : p) q = {double(coordinate(random)), double(coordinate(random)), double(coordinate(random))};
    const int expected = exact_orient3d(p[0], p[1], p[2], p[3]);
    for (const double scale : {1.0, 1e6, 0x1p-20}) {
      for (const double shift : {0.0, 1e3}) {
        for (const bool is_mirrored : {false, true}) {
          std::array<Vec3, 4> q;
          for (std::size_t i = 0; i < 4; ++i) {
            // Mirrored, or rotated by 90 degrees.
            q[i] = scale * (is_mirrored ? Vec3{p[i].y, p[i].x, p[i].z} : Vec3{-p[i].y, p[i].x, p[i].z}) + Vec3{shift, shift, -shift};
          }
          const int sense = is_mirrored ? -1 : 1;
          ASSERT_EQ(orient3d(q[0], q[1], q[2], q[3]), sense * expected);
        }
      }
    }
  }
}

TEST(Predicates, CoordinatesOfVeryDifferentSize) {
  std::mt19937_64 random(15);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int n = 0; n < 2000; ++n) {
    // Every second iteration uses the whole range that the header guarantees, 1e-80 .. 1e100.
    std::uniform_int_distribution<int> exponent(n % 2 == 0 ? -100 : -264, n % 2 == 0 ? 100 : 332);
    std::array<Vec3, 4> p;
    for (Vec3& q : p) {
      q = {std::ldexp(uniform(random), exponent(random)), std::ldexp(uniform(random), exponent(random)), std::ldexp(uniform(random), exponent(random))};
    }
    ASSERT_EQ(orient3d(p[0], p[1], p[2], p[3]), exact_orient3d(p[0], p[1], p[2], p[3]));
    ASSERT_EQ(orient2d({p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}), exact_orient2d({p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}));
  }
}

TEST(Predicates, RangeOfTheCircles) {
  // 1e-42 .. 1e60; points on the circle, and one unit in the last place beside it.
  for (const int exponent : {-138, 0, 198}) {
    for (const int n : {-1, 0, 1}) {
      std::array<Vec3, 5> p = {Vec3{0.7, 0.3, 0.9}, {0.7, 0.9, 0.9}, {0.1, 0.3, 0.9}, {0.1, 0.3, 0.2}, {0.7, 0.9, 0.2}};
      p[4].z = nudge(p[4].z, n);
      for (Vec3& q : p) q = std::ldexp(1.0, exponent) * q;
      const auto flat = [](const Vec3& q) { return Vec2{q.x, q.z}; };
      ASSERT_EQ(incircle(flat(p[0]), flat(p[2]), flat(p[3]), flat(p[4])), exact_incircle(flat(p[0]), flat(p[2]), flat(p[3]), flat(p[4])));
    }
  }
}

}  // namespace
}  // namespace sterna
