#include "volmesh/tetra/preflight.h"

#include <gmock/gmock.h>

#include <chrono>

#include "geom/mesh/find_crossings.h"
#include "tests/support/data.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"

namespace sterna::volmesh {
namespace {

using test::both;
using test::box;
using test::Domain;
using test::transformed;
using testing::HasSubstr;

Domain domain_of(const TriMesh& mesh) {
  Domain domain;
  domain.add(mesh);
  return domain;
}
PreflightReport report_of(const Domain& domain, const PreflightLimits& limits = {}) {
  const PreflightReport one = preflight(domain.boundary(), limits, RunContext({.threads = 1}));
  const PreflightReport many = preflight(domain.boundary(), limits, RunContext({.threads = 7}));
  EXPECT_EQ(one.counts, many.counts);
  EXPECT_EQ(one.findings.size(), many.findings.size());
  for (std::size_t i = 0; i < one.findings.size(); ++i) EXPECT_EQ(one.findings[i].triangles, many.findings[i].triangles);
  return one;
}
/// Expects only this kind of defect, with this count.
void expect_only(const PreflightReport& report, Trouble trouble, std::int64_t n) {
  for (const Trouble kind : {Trouble::crossing, Trouble::duplicate, Trouble::folded, Trouble::sliver, Trouble::gap})
    EXPECT_EQ(report.count(kind), kind == trouble ? n : 0) << to_string(kind);
}

// Only the check itself proves that a boundary is clear.
static_assert(!std::is_constructible_v<ClearProof, bool>);
static_assert(!std::is_aggregate_v<ClearProof>);

TEST(Preflight, ProofFollowsFromSearchedCrossingsAlone) {
  const Domain clear = domain_of(test::cube(2)), crossing = domain_of(both(test::cube(2), transformed(test::cube(2), 1.0, {0.3, 0.2, 0.1})));
  EXPECT_TRUE(report_of(clear).clear.is_given());
  EXPECT_FALSE(report_of(clear, {.searches_crossings = false}).clear.is_given());
  EXPECT_FALSE(report_of(crossing).clear.is_given());
  EXPECT_FALSE(ClearProof().is_given());
}

TEST(Preflight, NothingOnGoodSurfaces) {
  for (const double scale : {1e-30, 1e-6, 1.0, 1e6, 1e30}) {
    for (const double shift : {0.0, 1e3}) {
      for (const TriMesh& mesh : {test::cube(3), test::sphere(6)}) {
        expect_only(report_of(domain_of(transformed(mesh, scale, Vec3{shift, -shift, shift} * scale))), Trouble::gap, 0);
      }
    }
  }
}

TEST(Preflight, CrossingsAreThoseOfTheExactTest) {
  const Domain domain = domain_of(both(test::sphere(5), transformed(test::sphere(4), 0.7, {0.55, 0.1, 0.4})));
  const CrossingPairs crossings = find_crossings(domain.points, domain.triangles, RunContext{});
  ASSERT_GT(crossings.total, 10);
  const PreflightReport report = report_of(domain);
  EXPECT_EQ(report.count(Trouble::crossing), crossings.total);
  std::size_t i = 0;
  for (const PreflightFinding& finding : report.findings) {
    if (finding.trouble == Trouble::crossing) {
      EXPECT_EQ(finding.triangles, crossings.pairs[i++]);
    }
  }
  EXPECT_EQ(report_of(domain, {.searches_crossings = false}).count(Trouble::crossing), 0);
  const ErrorInfo error = test::error_info_of([&] { judge(report, domain.boundary(), RunContext{}); });
  EXPECT_EQ(error.code, ErrorCode::self_intersection);
  EXPECT_EQ(error.n_locations, crossings.total);
  EXPECT_FALSE(error.geometry.triangles.empty());
}

TEST(Preflight, TouchingIsCrossing) {
  EXPECT_GT(report_of(domain_of(both(box({0, 0, 0}, {1, 1, 1}), box({1, 0.1, 0.1}, {2, 0.9, 0.9})))).count(Trouble::crossing), 0);
}

TEST(Preflight, GapsAreMeasured) {
  // Two boxes one above the other: the triangles of the facing squares are opposite each other across the gap, which is `gap` over their mean edge.
  const double mean_edge = (2.0 + std::sqrt(2.0)) / 3.0;
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const double gap : {0.02, 0.005, 1e-6}) {
      const TriMesh mesh = both(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 1 + gap}, {1, 1, 2 + gap}));
      const PreflightReport report = report_of(domain_of(transformed(mesh, scale, {})));
      if (gap > 0.01 * mean_edge) {
        expect_only(report, Trouble::gap, 0);
        continue;
      }
      ASSERT_GE(report.count(Trouble::gap), 4);
      for (const PreflightFinding& finding : report.findings) EXPECT_NEAR(finding.value, gap / mean_edge, 1e-6 * gap + 1e-9);
    }
  }
}

TEST(Preflight, GapsBetweenEdgesAndPoints) {
  // A corner of one box, and an edge of another, close to the face of a box.
  const TriMesh base = box({-1, -1, -1}, {1, 1, 0});
  for (const auto& [tilt, name] : {std::pair{1, "edge"}, std::pair{2, "corner"}}) {
    SCOPED_TRACE(name);
    TriMesh other = box({0, 0, 0}, {0.5, 0.5, 0.5});
    for (Point& p : other.points) p = {p.x + 0.1, p.y, p.z + 0.003 + 0.3 * p.x + (tilt == 2 ? 0.4 * p.y : 0.0)};
    const PreflightReport report = report_of(domain_of(both(base, other)));
    EXPECT_GT(report.count(Trouble::gap), 0);
    EXPECT_EQ(report.count(Trouble::crossing), 0);
  }
}

TEST(Preflight, FoldsBelowTheAngle) {
  for (const double angle : {0.02, 0.01, 1e-4, 1e-8}) {  // rad; the limit is 0.01745
    // A wedge of this angle, sharp along one edge, 1 long and 1 deep.
    const double h = std::tan(angle);
    Domain domain;
    domain.points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, h}, {1, 1, h}};
    domain.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}};
    const PreflightReport report = report_of(domain, {.gap = 0.0});
    expect_only(report, Trouble::folded, angle < 0.01745 ? 1 : 0);
    if (angle < 0.01745) {
      EXPECT_NEAR(report.findings.front().value, angle, 1e-9);
    }
  }
}

TEST(Preflight, SliversAndDuplicates) {
  Domain domain;
  domain.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 5e-4, 0}, {0.5, 1, 0}};
  domain.triangles = {{0, 1, 2}, {0, 1, 3}};
  domain.triangles.pop_back();
  const PreflightReport report = report_of(domain);
  expect_only(report, Trouble::sliver, 1);
  EXPECT_NEAR(report.findings.front().value, 5e-4, 1e-9);
  domain.triangles = {{0, 1, 3}, {1, 3, 0}};
  expect_only(report_of(domain), Trouble::duplicate, 1);
}

TEST(Preflight, NamesThePatch) {
  const Domain domain = domain_of(both(test::cube(1), transformed(test::cube(1), 0.5, {0.75, 0.2, 0.3})));
  const std::vector<std::string> names = {"fuselage", "wing"};
  std::vector<std::uint32_t> patch(domain.triangles.size(), 0);
  std::fill(patch.begin() + 12, patch.end(), 1);
  TetraBoundary boundary = domain.boundary();
  boundary.patch_names = names;
  boundary.triangle_patch = patch;
  const ErrorInfo error = test::error_info_of([&] { judge(preflight(boundary, {}, RunContext{}), boundary, RunContext{}); });
  ASSERT_FALSE(error.locations.empty());
  EXPECT_THAT(error.locations[0].what, HasSubstr("patch \"fuselage\""));
}

TEST(Preflight, WarnsOfWhatEnginesFindHard) {
  std::vector<std::string> log;
  const RunContext context({.log = [&](LogLevel level, std::string_view text) {
    if (level == LogLevel::warning) log.emplace_back(text);
  }});
  const Domain domain = domain_of(both(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 1.001}, {1, 1, 2})));
  judge(preflight(domain.boundary(), {}, context), domain.boundary(), context);
  EXPECT_THAT(log, testing::ElementsAre(HasSubstr("close to each other")));
}

}  // namespace
}  // namespace sterna::volmesh
