// A coarse mesh that provides the sizes for the final mesh.
#include "volmesh/tetra/two_pass.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"
#include "volmesh/tetra/size_supply.h"

namespace sterna::volmesh {
namespace {

using test::Domain;
using test::error_info_of;
using test::expect_tiling;

TetraResult fill_twice(const Domain& domain, const SizeField* sizes, int threads = 2) {
  return fill(domain.boundary(), sizes, {.two_pass = true}, RunContext({.threads = threads}));
}

std::array<Vec3, 4> corners_of(const Domain& domain, const TetraResult& result, std::size_t tet) {
  std::array<Vec3, 4> p;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t v = result.tetrahedra[tet][k];
    p[k] = v < domain.points.size() ? domain.points[v] : result.new_points[v - domain.points.size()];
  }
  return p;
}

double volume_of(const std::array<Vec3, 4>& p) { return dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0])) / 6.0; }

/// Returns the share of the faces between tetrahedra across which the volume changes by more than a factor of four (G15).
double share_of_jumps(const Domain& domain, const TetraResult& result) {
  std::map<std::array<std::uint32_t, 3>, double> open;
  double n = 0.0, n_jumps = 0.0;
  for (std::size_t t = 0; t < result.tetrahedra.size(); ++t) {
    const double volume = volume_of(corners_of(domain, result, t));
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::array<std::uint32_t, 3> face{};
      for (std::size_t k = 0, i = 0; k < 4; ++k)
        if (k != left_out) face[i++] = result.tetrahedra[t][k];
      std::ranges::sort(face);
      const auto [it, is_new] = open.try_emplace(face, volume);
      if (is_new) continue;
      n += 1.0;
      n_jumps += std::max(volume, it->second) > 4.0 * std::min(volume, it->second);
    }
  }
  return n_jumps / n;
}

TEST(TwoPass, TransitionIsSmootherThanInOnePass) {
  const Domain domain = test::domain_around(test::sphere(8), 10.0);
  const TetraResult twice = fill_twice(domain, nullptr);
  expect_tiling(domain, twice);
  EXPECT_TRUE(twice.is_two_pass);
  EXPECT_EQ(twice.engine, "tetgen");
  const TetraResult once = fill(domain.boundary(), nullptr, {.engine = "tetgen"}, RunContext());
  EXPECT_FALSE(once.is_two_pass);
  EXPECT_LT(share_of_jumps(domain, twice), share_of_jumps(domain, once));
}

TEST(TwoPass, SizesOfTheFieldAreObeyedToo) {
  const Domain domain = test::domain_around(test::sphere(5), 10.0);
  const TetraBoundary boundary = domain.boundary();
  const std::vector<SizeSource> sources = {{.kind = SourceKind::sphere, .from = {4, 0, 0}, .radius = 1.0, .size = 0.2}};
  const RunContext context({.threads = 2});
  SizeSupply sizes(boundary, sources, {}, context);
  const TetraResult result = fill(boundary, sizes, {.two_pass = true}, context);
  expect_tiling(domain, result);
  double longest = 0.0;
  int n = 0;
  for (std::size_t t = 0; t < result.tetrahedra.size(); ++t) {
    const auto p = corners_of(domain, result, t);
    const Vec3 middle = 0.25 * (p[0] + p[1] + p[2] + p[3]);
    if (distance(middle, {4, 0, 0}) > 0.8) continue;
    ++n;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) longest = std::max(longest, distance(p[i], p[j]));
  }
  EXPECT_GT(n, 1000);           // 2.1 m^3 in tetrahedra of 0.2 m edges, 9.4e-4 m^3 each
  EXPECT_LT(longest, 2 * 0.2);  // the target length is a mean
}

TEST(TwoPass, NodalSizesAreSmoothAndKeepTheBoundarys) {
  const Domain domain = test::domain_around(test::sphere(5), 10.0);
  const TetraResult coarse = fill(domain.boundary(), nullptr, {.engine = "tetgen", .radius_edge = k_coarse_radius_edge}, RunContext());
  const SizeSource samples = nodal_sizes(domain.boundary(), coarse, RunContext());
  ASSERT_EQ(samples.points.size(), coarse.new_points.size());
  ASSERT_EQ(samples.sizes.size(), coarse.new_points.size());
  const auto [least, most] = std::ranges::minmax(samples.sizes);
  EXPECT_GT(least, 0.0);
  EXPECT_LT(most, 10.0);
  EXPECT_EQ(problem_of(samples, 1.3), "");
}

TEST(TwoPass, IsTheSameForAnyNumberOfThreads) {
  const Domain domain = test::domain_around(test::cube(3), 5.0);
  const TetraResult expected = fill_twice(domain, nullptr, 1);
  for (const int threads : {2, 7}) {
    const TetraResult other = fill_twice(domain, nullptr, threads);
    EXPECT_EQ(other.tetrahedra, expected.tetrahedra);
    EXPECT_EQ(other.new_points, expected.new_points);
  }
}

TEST(TwoPass, IsForTetgenOnly) {
  const Domain domain = test::domain_around(test::cube(1), 5.0);
  const ErrorInfo error = error_info_of([&] { fill(domain.boundary(), nullptr, {.engine = "hxt", .two_pass = true}, RunContext()); });
  EXPECT_EQ(error.code, ErrorCode::bad_argument);
  EXPECT_THAT(error.problem, testing::HasSubstr("two_pass"));
}

}  // namespace
}  // namespace sterna::volmesh
