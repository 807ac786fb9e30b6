// Blocks for parallel work: every location is in one of the boxes, and each box has its share of the points.
#include "geom/tets/blocks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sterna::tets {
namespace {

std::vector<Vec3> cloud(std::size_t n, bool is_flat) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> at(-5.0, 20.0);
  std::vector<Vec3> points(n);
  for (Vec3& p : points) {
    p.x = at(generator);
    p.y = is_flat ? 1.0 : at(generator);
    p.z = is_flat ? std::floor(at(generator)) : at(generator);
  }
  return points;
}

TEST(TetBlocks, EveryPlaceIsInOneBlock) {
  for (const bool is_flat : {false, true}) {
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{5000}}) {
      const std::vector<Vec3> points = cloud(n, is_flat);
      const Blocks blocks(points, 5, 0.4, RunContext{});
      ASSERT_EQ(blocks.size(), 32u);
      std::vector<Vec3> locations = cloud(200, false);
      locations.insert(locations.end(), points.begin(), points.end());
      for (const Vec3& p : locations) {
        const std::size_t found = blocks.find(p);
        for (std::size_t i = 0; i < blocks.size(); ++i) ASSERT_EQ(blocks[i].holds(p), i == found) << n << " points, flat " << is_flat;
      }
    }
  }
}

TEST(TetBlocks, PointsAreSharedOutAndPlanesMove) {
  const std::vector<Vec3> points = cloud(6400, false);
  const Blocks even(points, 6, 0.5, RunContext({.threads = 1})), uneven(points, 1, 0.4, RunContext({.threads = 2}));
  std::vector<int> counts(64);
  for (const Vec3& p : points) ++counts[even.find(p)];
  for (const int count : counts) EXPECT_EQ(count, 100);
  int n_low = 0;
  for (const Vec3& p : points) n_low += uneven.find(p) == 0;
  EXPECT_EQ(n_low, 2560);
}

}  // namespace
}  // namespace sterna::tets
