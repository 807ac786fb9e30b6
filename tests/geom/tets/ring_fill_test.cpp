#include "geom/tets/ring_fill.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace sterna::tets {
namespace {

using Triangle = std::array<std::size_t, 3>;

const auto k_free = [](std::size_t, std::size_t, double sum) { return sum; };

/// Returns the lowest sum of costs over all triangulations of the corners from i to k.
template <class Cost>
double by_trial(std::size_t i, std::size_t k, const Cost& cost) {
  if (k < i + 2) return 0.0;
  double least = 1e300;
  for (std::size_t j = i + 1; j < k; ++j) least = std::min(least, by_trial(i, j, cost) + by_trial(j, k, cost) + cost(i, j, k));
  return least;
}

TEST(RingFill, FindsLowestSumOfAllTriangulations) {
  const auto cost = [](std::size_t i, std::size_t j, std::size_t k) { return static_cast<double>((7 * i + 13 * j * j + 5 * k * i + 3) % 17); };
  for (std::size_t n = 3; n <= 9; ++n) {
    RingFill<9> fill;
    ASSERT_TRUE(fill.find(
        n, 1e9, [&](std::size_t i, std::size_t j, std::size_t k, double sum, double) { return sum + cost(i, j, k); }, k_free));
    EXPECT_EQ(fill.cost(), by_trial(0, n - 1, cost));
    double sum = 0.0;
    std::size_t n_triangles = 0;
    fill.for_triangles([&](std::size_t i, std::size_t j, std::size_t k) {
      sum += cost(i, j, k);
      ++n_triangles;
    });
    EXPECT_EQ(sum, fill.cost());
    EXPECT_EQ(n_triangles, n - 2);
  }
}

TEST(RingFill, DiagonalWithHighCostIsAvoided) {
  RingFill<4> fill;
  ASSERT_TRUE(fill.find(
      4, 1e9, [](std::size_t, std::size_t, std::size_t, double sum, double) { return sum; },
      [](std::size_t i, std::size_t, double sum) { return sum + (i == 0 ? 1.0 : 0.0); }));
  std::vector<Triangle> found;
  fill.for_triangles([&](std::size_t i, std::size_t j, std::size_t k) { found.push_back({i, j, k}); });
  EXPECT_EQ(found, (std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}}));
}

TEST(RingFill, NothingIsFoundAtTheLimit) {
  RingFill<5> fill;
  const auto one = [](std::size_t, std::size_t, std::size_t, double sum, double) { return sum + 1.0; };
  EXPECT_TRUE(fill.find(5, 3.5, one, k_free));
  EXPECT_FALSE(fill.find(5, 3.0, one, k_free));
  EXPECT_FALSE(fill.find(2, 3.5, one, k_free));
}

TEST(RingFill, OtherTwoCornersMakePositiveOrder) {
  const Corners v{10, 11, 12, 13};
  EXPECT_EQ(other_two(v, 10, 11), (std::array<std::uint32_t, 2>{12, 13}));
  EXPECT_EQ(other_two(v, 11, 10), (std::array<std::uint32_t, 2>{13, 12}));
  EXPECT_EQ(other_two(v, 13, 11), (std::array<std::uint32_t, 2>{10, 12}));
}

}  // namespace
}  // namespace sterna::tets
