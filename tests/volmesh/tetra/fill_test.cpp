#include <gmock/gmock.h>

#include "tests/support/data.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"
#include "volmesh/domain/farfield.h"

namespace sterna::volmesh {
namespace {

using test::both;
using test::box;
using test::Domain;
using test::domain_around;
using test::error_info_of;
using test::expect_tiling;
using test::inside_out;
using test::proof_of_another_boundary;
using test::transformed;
using testing::HasSubstr;

TetraResult fill(const Domain& domain, const TetraOptions& options = {}) { return fill(domain.boundary(), nullptr, options, RunContext{}); }

/// Requirements for each engine.
class FillWith : public testing::TestWithParam<std::string> {
 protected:
  TetraOptions options() const { return {.engine = GetParam()}; }
  TetraResult fill(const Domain& domain) const { return volmesh::fill(domain.boundary(), nullptr, options(), RunContext{}); }
};
INSTANTIATE_TEST_SUITE_P(Engine, FillWith, testing::Values("tetgen", "hxt"), [](const auto& test) { return test.param; });

TEST_P(FillWith, FillsBetweenOneBodyAndTheFarfield) {
  for (const TriMesh& wall : {test::cube(1), test::cube(4), test::sphere(6)}) {
    const Domain domain = domain_around(wall);
    const TetraResult result = fill(domain);
    expect_tiling(domain, result);
    EXPECT_GT(result.engine_seconds, 0.0);
    EXPECT_GT(result.engine_peak_bytes, 1e6);
  }
}

TEST_P(FillWith, FillsAroundSeveralBodies) {
  TriMesh wall = both(test::cube(2), transformed(test::sphere(4), 0.5, {3, 0, 0}));
  wall = both(wall, transformed(test::cube(1), 0.25, {1.0001, 0.3, 0.3}));  // a gap of 1e-4
  const Domain domain = domain_around(wall);
  EXPECT_EQ(domain.holes.size(), 3u);
  expect_tiling(domain, fill(domain));
}

TEST_P(FillWith, FillsTheHoleInsideAHollowBody) {
  const TriMesh wall = both(test::sphere(5), inside_out(transformed(test::sphere(4), 0.5, {})));
  const Domain domain = domain_around(wall, 20.0);
  EXPECT_EQ(domain.holes.size(), 1u);
  expect_tiling(domain, fill(domain));
}

TEST_P(FillWith, FillsAroundRazorThinBodies) {
  // TetGen merges points closer than 1e-8 of the box, and crashes then, unless merging is disabled.
  for (const double thickness : {1e-3, 1e-6, 1e-9, 1e-12}) {
    SCOPED_TRACE(thickness);
    TriMesh wall = test::cube(3);
    for (Point& p : wall.points) p.z *= thickness;
    const Domain domain = domain_around(wall);
    expect_tiling(domain, fill(domain));
  }
}

TEST_P(FillWith, DoesNotDependOnUnitPlaceOrHandedness) {
  const TriMesh wall = both(test::cube(2), transformed(test::sphere(3), 0.5, {2, 0.1, 0.2}));
  for (const double scale : {1e-6, 1.0, 1e6, 1e-30, 1e30}) {
    for (const double shift : {0.0, 1e3}) {
      SCOPED_TRACE(testing::Message() << scale << " " << shift);
      const Domain domain = domain_around(transformed(wall, scale, Vec3{shift, -shift, 2 * shift} * scale));
      expect_tiling(domain, fill(domain));
    }
  }
  TriMesh mirrored = inside_out(wall);
  for (Point& p : mirrored.points) p.y = -p.y;
  const Domain domain = domain_around(mirrored);
  expect_tiling(domain, fill(domain));
}

TEST_P(FillWith, GivesSameMeshInPowerOfTwoUnits) {
  const Domain domain = domain_around(test::sphere(4));
  Domain small = domain;
  for (Vec3& p : small.points) p *= 0x1p-20;
  for (Vec3& p : small.holes) p *= 0x1p-20;
  const TetraResult a = fill(domain), b = fill(small);
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  ASSERT_EQ(a.new_points.size(), b.new_points.size());
  for (std::size_t i = 0; i < a.new_points.size(); ++i) EXPECT_EQ(0x1p-20 * a.new_points[i], b.new_points[i]);
}

TEST_P(FillWith, TakesTheVerticesInAnyOrder) {
  const Domain domain = domain_around(test::cube(2));
  for (const std::uint32_t step : {5u, 7u, 11u}) {
    Domain shuffled = domain;
    const auto n = static_cast<std::uint32_t>(domain.points.size());
    ASSERT_NE(n % step, 0u);
    const auto new_number = [&](std::uint32_t v) { return v * step % n; };
    for (std::uint32_t v = 0; v < n; ++v) shuffled.points[new_number(v)] = domain.points[v];
    for (auto& t : shuffled.triangles) t = {new_number(t[1]), new_number(t[2]), new_number(t[0])};
    std::ranges::reverse(shuffled.triangles);
    expect_tiling(shuffled, fill(shuffled));
  }
}

TEST_P(FillWith, IsDeterministicForAnyNumberOfThreads) {
  const Domain domain = domain_around(both(test::cube(6), transformed(test::sphere(8), 0.5, {2, 0.1, 0.2})));
  const TetraResult first = fill(domain);
  for (const int threads : {1, 2, 7}) {
    const TetraResult again = volmesh::fill(domain.boundary(), nullptr, options(), RunContext({.threads = threads}));
    EXPECT_EQ(first.tetrahedra, again.tetrahedra);
    EXPECT_EQ(first.new_points, again.new_points);
  }
}

TEST(FillWithTetgen, RefinesWithTheRadiusEdgeRatio) {
  const Domain domain = domain_around(test::sphere(6));
  EXPECT_GT(fill(domain, {.engine = "tetgen", .radius_edge = 1.2}).tetrahedra.size(), fill(domain, {.engine = "tetgen", .radius_edge = 2.0}).tetrahedra.size());
}

TEST(FillWithHxt, ImprovesWhatItIsTold) {
  const Domain domain = domain_around(test::sphere(6));
  EXPECT_NE(fill(domain, {.engine = "hxt", .hxt_improve_below = 0.0}).tetrahedra, fill(domain, {.engine = "hxt", .hxt_improve_below = 0.3}).tetrahedra);
}

TEST(Fill, RefusesAnUnknownEngine) {
  const ErrorInfo error = error_info_of([&] { fill(domain_around(test::cube(1)), {.engine = "steam"}); });
  EXPECT_EQ(error.code, ErrorCode::bad_argument);
  EXPECT_THAT(error.problem, HasSubstr("steam"));
}

TEST(Fill, TwoRegionsOneInsideTheOther) {
  // A hollow body with another body in its cavity: the domain has two parts, and each part must use the hole point of its own body.
  const TriMesh wall = both(both(test::sphere(5), inside_out(transformed(test::sphere(4), 0.5, {}))), transformed(test::cube(2), 0.1, {}));
  const Domain domain = domain_around(both(wall, transformed(test::cube(1), 0.3, {4, 0, 0})), 40.0);
  for (const char* engine : {"tetgen", "hxt"}) expect_tiling(domain, fill(domain, {.engine = engine}));
}

/// Real surfaces, their own triangles as inner boundary: sharp edges, needles, several bodies.
TEST_P(FillWith, FillsAroundRealSurfaces) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"cgal_data_anchor_dense.off", "cgal_data_couplingdown.off", "caturbs_wing_wing.stl", "pygeo_bwb.stl"}) {
    SCOPED_TRACE(name);
    const TriMesh wall = test::read_welded(test::shared_data() / "surfaces" / "clean" / name);
    ASSERT_GT(wall.n_triangles(), 500u);
    const Domain domain = domain_around(wall);
    expect_tiling(domain, fill(domain));
  }
}

TEST_P(FillWith, RejectsAnOpenBoundary) {
  Domain domain = domain_around(test::cube(2));
  domain.triangles.erase(domain.triangles.begin() + 3);
  const ErrorInfo error = error_info_of([&] { fill(domain); });
  EXPECT_EQ(error.code, ErrorCode::open_surface);
  EXPECT_THAT(error.problem, HasSubstr("3 edges"));
  EXPECT_EQ(error.n_locations, 3);
  EXPECT_EQ(error.locations.size(), 3u);
  EXPECT_EQ(error.geometry.triangles.size(), 3u);
}

TEST_P(FillWith, RejectsADuplicateTriangle) {
  Domain domain = domain_around(test::cube(1));
  domain.triangles.push_back(domain.triangles[0]);
  const ErrorInfo error = error_info_of([&] { fill(domain); });
  EXPECT_EQ(error.code, ErrorCode::non_manifold_surface);
  EXPECT_EQ(error.n_locations, 3);
}

TEST_P(FillWith, RejectsATurnedTriangle) {
  Domain domain = domain_around(test::cube(1));
  std::swap(domain.triangles[0][0], domain.triangles[0][1]);
  EXPECT_EQ(error_info_of([&] { fill(domain); }).code, ErrorCode::non_manifold_surface);
}

TEST_P(FillWith, RejectsAnIndexOutOfRange) {
  Domain domain = domain_around(test::cube(1));
  domain.triangles[5][1] = 99999;
  const ErrorInfo error = error_info_of([&] { fill(domain); });
  EXPECT_EQ(error.code, ErrorCode::bad_argument);
  EXPECT_THAT(error.problem, HasSubstr("out of range"));
  ASSERT_EQ(error.locations.size(), 1u);
  EXPECT_THAT(error.locations[0].what, HasSubstr("triangle 5"));
  EXPECT_THAT(error.locations[0].what, HasSubstr("99999"));
}

TEST_P(FillWith, RejectsBadPoints) {
  const Domain good = domain_around(test::cube(1));
  Domain domain = good;
  domain.points[4].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_info_of([&] { fill(domain); }).code, ErrorCode::bad_argument);
  domain = good;
  domain.points.push_back({3, 3, 3});
  EXPECT_THAT(error_info_of([&] { fill(domain); }).problem, HasSubstr("no triangle uses"));
  domain = good;
  domain.points[4] = domain.points[5];
  const ErrorInfo twins = error_info_of([&] { fill(domain); });
  EXPECT_EQ(twins.code, ErrorCode::self_intersection);
  ASSERT_EQ(twins.locations.size(), 1u);
  EXPECT_EQ(twins.locations[0].position, good.points[5]);
  domain = good;
  domain.triangles[0] = {domain.triangles[0][0], domain.triangles[0][0], domain.triangles[0][1]};
  EXPECT_EQ(error_info_of([&] { fill(domain); }).code, ErrorCode::bad_argument);
  domain = good;
  domain.holes[0].x = std::numeric_limits<double>::infinity();
  EXPECT_EQ(error_info_of([&] { fill(domain); }).code, ErrorCode::bad_argument);
  EXPECT_EQ(error_info_of([&] { fill(Domain{}); }).code, ErrorCode::bad_argument);
}

TEST(Fill, TellsWhereTheBoundaryCrossesItself) {
  for (const double shift : {0.3, 0.55, 0.8}) {
    SCOPED_TRACE(shift);
    const TriMesh wall = both(test::sphere(3), transformed(test::sphere(4), 0.7, {shift, 0.1, 0.4}));
    Domain domain;
    domain.add(wall);
    domain.add(farfield_sphere(wall, {}, RunContext{}));
    domain.holes = {{0.01, 0.02, 0.03}, {shift, 0.1, 0.4}};
    const ErrorInfo error = error_info_of([&] { fill(domain); });
    EXPECT_EQ(error.code, ErrorCode::self_intersection);
    EXPECT_THAT(error.problem, HasSubstr("that cross"));
    ASSERT_FALSE(error.locations.empty());
    EXPECT_GT(error.n_locations, 10);
    EXPECT_FALSE(error.geometry.triangles.empty());
    EXPECT_LT(norm(error.locations[0].position), 1.2);
    // An engine that receives such input without a check crashes in some of these cases and returns incomplete triangles in others; neither does harm.
    TetraBoundary boundary = domain.boundary();
    boundary.clear = proof_of_another_boundary();
    const ErrorCode code = error_info_of([&] { volmesh::fill(boundary, nullptr, {}, RunContext{}); }).code;
    EXPECT_TRUE(code == ErrorCode::tetra_engine_failed || code == ErrorCode::tetra_result_invalid);
  }
}

TEST(Fill, RejectsTouchingBodies) {
  const TriMesh wall = both(box({0, 0, 0}, {1, 1, 1}), box({1, 0.1, 0.1}, {2, 0.9, 0.9}));
  const Domain domain = domain_around(wall);
  EXPECT_EQ(domain.holes.size(), 2u);
  EXPECT_EQ(error_info_of([&] { fill(domain); }).code, ErrorCode::self_intersection);
}

TEST(FillWithTetgen, RejectsWrongHolePoints) {
  const TetraOptions alone = {.engine = "tetgen", .try_other_engine = false};  // HXT does not use hole points
  Domain domain = domain_around(test::cube(2));
  domain.holes.clear();
  EXPECT_EQ(error_info_of([&] { fill(domain, alone); }).code, ErrorCode::tetra_result_invalid);
  domain.holes = {{5, 5, 5}};
  EXPECT_EQ(error_info_of([&] { fill(domain, alone); }).code, ErrorCode::tetra_result_invalid);
}

}  // namespace
}  // namespace sterna::volmesh
