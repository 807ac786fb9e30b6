// All engines follow the same size field.
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"
#include "volmesh/tetra/size_supply.h"

namespace sterna::volmesh {
namespace {

using test::Domain;
using test::domain_around;
using test::expect_tiling;

// A supply refers to the field, or to the boundary and the sources.
static_assert(std::is_constructible_v<SizeSupply, const SizeField&> && !std::is_constructible_v<SizeSupply, SizeField>);
static_assert(std::is_constructible_v<SizeSupply, TetraBoundary&, std::vector<SizeSource>&, SizeFieldOptions, RunContext>);
static_assert(!std::is_constructible_v<SizeSupply, TetraBoundary, std::vector<SizeSource>&, SizeFieldOptions, RunContext>);
static_assert(!std::is_constructible_v<SizeSupply, TetraBoundary&, std::vector<SizeSource>, SizeFieldOptions, RunContext>);

class SizedFill : public testing::TestWithParam<std::string> {
 protected:
  TetraResult fill(const SizeField& sizes, int threads = 1) const {
    return volmesh::fill(domain.boundary(), &sizes, {.engine = GetParam()}, RunContext({.threads = threads}));
  }
  SizeField field(std::vector<SizeSource> sources, double growth = 1.3) const {
    return build_size_field(domain.boundary(), sources, {.size_growth = growth}, RunContext{});
  }
  Domain domain = domain_around(test::sphere(8), 10.0);
};
INSTANTIATE_TEST_SUITE_P(Engine, SizedFill, testing::Values("tetgen", "hxt", "sterna"), [](const auto& test) { return test.param; });

/// Ratio of edge lengths to the target sizes at their midpoints: geometric mean over the edges whose midpoints lie in a ball.
double mean_edge_ratio(const Domain& domain, const TetraResult& result, const SizeField& sizes, const Vec3& center, double radius) {
  const auto point = [&](std::uint32_t v) { return v < domain.points.size() ? domain.points[v] : result.new_points[v - domain.points.size()]; };
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& tet : result.tetrahedra) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) edges.insert(std::minmax(tet[i], tet[j]));
    }
  }
  double sum = 0.0;
  int n = 0;
  for (const auto& [a, b] : edges) {
    const Vec3 middle = 0.5 * (point(a) + point(b));
    if (distance(middle, center) > radius) continue;
    sum += std::log(distance(point(a), point(b)) / sizes(middle));
    ++n;
  }
  EXPECT_GT(n, 100);
  return std::exp(sum / n);
}

TEST_P(SizedFill, MakesEdgesOfTheWantedLength) {
  const SizeField sizes = field({{.kind = SourceKind::sphere, .from = {4, 0, 0}, .radius = 1.0, .size = 0.15}});
  const TetraResult result = fill(sizes);
  expect_tiling(domain, result);
  // 5 %: over the ball the size varies only by the octree's interpolation. Elsewhere sizes double within a few edges, which favours the longer edges.
  EXPECT_NEAR(mean_edge_ratio(domain, result, sizes, {4, 0, 0}, 0.9), 1.0, 0.05);
  EXPECT_NEAR(mean_edge_ratio(domain, result, sizes, {0, 4, 0}, 2.5), 1.1, 0.2);
}

TEST_P(SizedFill, GrowsAsItIsTold) { EXPECT_GT(fill(field({}, 1.15)).tetrahedra.size(), 1.5 * static_cast<double>(fill(field({}, 1.5)).tetrahedra.size())); }

TEST_P(SizedFill, IsDeterministic) {
  const SizeField sizes = field({});
  const TetraResult first = fill(sizes), again = fill(sizes, 7);
  EXPECT_EQ(first.tetrahedra, again.tetrahedra);
  EXPECT_EQ(first.new_points, again.new_points);
}

TEST_P(SizedFill, MeasuresInMetresWhateverTheUnit) {
  // The same domain in units of 2^-20 gives the same mesh, since coordinates are passed to the engine scaled by a power of two.
  const TetraResult large = fill(field({}));
  for (Vec3& p : domain.points) p *= 0x1p-20;
  for (Vec3& p : domain.holes) p *= 0x1p-20;
  EXPECT_EQ(large.tetrahedra, fill(field({})).tetrahedra);
}

TEST(SizedFillBoth, EnginesMakeAboutAsManyTetrahedra) {
  const Domain domain = domain_around(test::sphere(10), 20.0);
  const std::vector<SizeSource> sources = {{.kind = SourceKind::sphere, .radius = 3.0, .size = 0.2}};
  const SizeField sizes = build_size_field(domain.boundary(), sources, {}, RunContext{});
  const auto count = [&](const char* engine) {
    return static_cast<double>(fill(domain.boundary(), &sizes, {.engine = engine}, RunContext{}).tetrahedra.size());
  };
  for (const char* other : {"tetgen", "sterna"}) {
    const double ratio = count(other) / count("hxt");
    EXPECT_GT(ratio, 1.0 / 1.3) << other;
    EXPECT_LT(ratio, 1.3) << other;
  }
}

TEST_P(SizedFill, ConcurrentSizeSupplyGivesTheSameMesh) {
  const TetraResult expected = fill(field({}));
  for (const int threads : {1, 2}) {
    const RunContext context({.threads = threads});
    const TetraBoundary boundary = domain.boundary();
    const std::vector<SizeSource> no_sources;
    SizeSupply sizes(boundary, no_sources, {}, context);
    const TetraResult result = volmesh::fill(boundary, sizes, {.engine = GetParam()}, context);
    EXPECT_EQ(result.tetrahedra, expected.tetrahedra);
    EXPECT_EQ(result.new_points, expected.new_points);
  }
}

TEST_P(SizedFill, ASupplyThatFailsEndsTheEngine) {
  const RunContext context({.threads = 2});
  const TetraBoundary boundary = domain.boundary();
  const std::vector<SizeSource> sources = {{.kind = SourceKind::sphere, .from = {4, 0, 0}, .radius = 1.0, .size = -1.0}};
  SizeSupply sizes(boundary, sources, {}, context);
  EXPECT_EQ(test::error_info_of([&] { volmesh::fill(boundary, sizes, {.engine = GetParam()}, context); }).code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace sterna::volmesh
