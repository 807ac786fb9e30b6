// Splits of boundary triangles: their extraction from an engine's reply, and their transfer by fill().
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/support/data.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"
#include "volmesh/tetra/engine_process.h"

namespace sterna::volmesh {
namespace {

using test::Domain;
using test::domain_around;
using test::error_info_of;
using testing::ElementsAre;
using testing::HasSubstr;
using Triangle = std::array<std::uint32_t, 3>;

/// The surface of a tetrahedron whose edge 0-1 is split at a quarter, and whose triangle 1 2 3 has a point inside.
struct Example {
  std::vector<Vec3> old_points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Triangle> old_triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25, 0, 0}, {0.5, 0.25, 0.25}};
  /// Parents in arbitrary order, with mixed orientations.
  std::vector<Triangle> triangles = {{5, 1, 3}, {0, 2, 4}, {4, 1, 2}, {0, 2, 3}, {5, 3, 2}, {0, 3, 4}, {4, 1, 3}, {2, 5, 1}};
  std::vector<std::uint32_t> parents = {3, 0, 0, 2, 3, 1, 1, 3};
  BoundarySplits find() const { return find_splits({.points = old_points, .triangles = old_triangles, .hole_points = {}}, points, triangles, parents); }
};

TEST(BoundarySplits, OriginsSensesAndOrder) {
  const BoundarySplits splits = Example().find();
  EXPECT_THAT(splits.parents, ElementsAre(0, 0, 1, 1, 2, 3, 3, 3));
  ASSERT_EQ(splits.origins.size(), 2u);
  EXPECT_EQ(splits.origins[0].triangle, 0u);
  EXPECT_THAT(splits.origins[0].weights, ElementsAre(0.75, 0.25, 0.0));
  EXPECT_EQ(splits.origins[1].triangle, 3u);
  EXPECT_THAT(splits.origins[1].weights, ElementsAre(testing::DoubleEq(0.5), testing::DoubleEq(0.25), testing::DoubleEq(0.25)));
  // Orientation: the normals of the parts equal those of their parents.
  const Example e;
  for (std::size_t i = 0; i < splits.triangles.size(); ++i) {
    const auto normal = [](const std::vector<Vec3>& p, const Triangle& t) { return cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]); };
    EXPECT_GT(dot(normal(e.points, splits.triangles[i]), normal(e.old_points, e.old_triangles[splits.parents[i]])), 0.0) << i;
  }
}

TEST(BoundarySplits, RejectWhatIsNoSubdivision) {
  const auto problem = [](const auto& change) {
    Example e;
    change(e);
    const ErrorInfo error = error_info_of([&] { e.find(); });
    EXPECT_EQ(error.code, ErrorCode::tetra_result_invalid);
    return error.problem;
  };
  EXPECT_THAT(problem([](Example& e) { e.triangles.pop_back(), e.parents.pop_back(); }), HasSubstr("times its area"));
  EXPECT_THAT(problem([](Example& e) { e.triangles.push_back(e.triangles[0]), e.parents.push_back(e.parents[0]); }), HasSubstr("times its area"));
  EXPECT_THAT(problem([](Example& e) { e.points[4].x = -0.25; }), HasSubstr("outside of the edge"));
  EXPECT_THAT(problem([](Example& e) { e.points[5] = {2, -0.5, -0.5}; }), HasSubstr("outside of the triangle"));
  EXPECT_THAT(problem([](Example& e) { e.triangles[3] = {4, 2, 3}; }), HasSubstr("three triangles"));
  EXPECT_THAT(problem([](Example& e) { e.parents[3] = 4; }), HasSubstr("boundary triangle 4 of 4"));
  EXPECT_THAT(problem([](Example& e) { e.parents[3] = 0; }), HasSubstr("corner of another"));
  EXPECT_THAT(problem([](Example& e) { e.triangles[1] = {0, 4, 0}; }), HasSubstr("no area"));
  EXPECT_THAT(problem([](Example& e) { e.triangles[1] = {0, 2, 9}; }), HasSubstr("does not exist"));
  EXPECT_THAT(problem([](Example& e) { e.points.push_back({0, 0, 0}); }), HasSubstr("has no triangle"));
}

/// Returns a folder where TetGen's helper crashes unless splits are allowed, and HXT's always crashes.
std::string folder_that_needs_splits() {
  const std::filesystem::path folder = test::scratch() / "helpers";
  std::filesystem::create_directories(folder);
  // Byte 80 of the request: RequestHeader::splits.
  const std::string real = find_helper("sterna-tet-tetgen", {});
  std::ofstream(folder / "sterna-tet-tetgen") << "#!/bin/sh\nmode=$(od -An -tu1 -j80 -N1 /proc/self/fd/3)\n[ $mode = 2 ] || kill -SEGV $$\nexec " << real
                                              << "\n";
  std::ofstream(folder / "sterna-tet-hxt") << "#!/bin/sh\nkill -SEGV $$\n";
  for (const char* name : {"sterna-tet-tetgen", "sterna-tet-hxt"}) std::filesystem::permissions(folder / name, std::filesystem::perms::owner_all);
  return folder.string();
}

/// Returns the domain with its splits made, for expect_tiling().
Domain as_split(const Domain& domain, const BoundarySplits& splits) {
  Domain split = domain;
  split.points.insert(split.points.end(), splits.points.begin(), splits.points.end());
  split.triangles = splits.triangles;
  return split;
}

class FillWithSplits : public testing::Test {
 protected:
  /// Tries the engines in turn until `taker` accepts a result with splits; `taker` throws for splits that it cannot handle. Without a `taker` no splits are
  /// allowed.
  TetraResult fill(const TetraOptions& options, const std::function<void(TetraResult&)>& taker) {
    const RunContext context({.log = [this](LogLevel level, std::string_view text) {
      if (level == LogLevel::warning) log_ += std::string(text) + "\n";
    }});
    TetraLadder ladder(domain_.boundary(), nullptr, options, taker ? SplitPermission::permitted : SplitPermission::never, context);
    for (;;) {
      TetraResult result = ladder.next();
      if (result.splits.empty()) return result;
      try {
        taker(result);
        return result;
      } catch (const Error& error) {
        ladder.reject(error);
      }
    }
  }
  Domain domain_ = domain_around(test::box({0, 0, 0}, {1, 0.3, 0.1}), 10.0);
  std::string log_;
};

TEST_F(FillWithSplits, AlwaysSplitsForBetterTetrahedra) {
  int n_taken = 0;
  const TetraResult result = fill({.radius_edge = 1.2, .boundary_splits = "always"}, [&](TetraResult& r) { n_taken += r.splits.empty() ? 0 : 1; });
  EXPECT_EQ(n_taken, 1);
  EXPECT_EQ(result.engine, "tetgen");
  EXPECT_FALSE(result.splits.empty());
  expect_tiling(as_split(domain_, result.splits), result);
}

TEST_F(FillWithSplits, AreTheLastStepOfTheLadder) {
  const TetraOptions options = {.helper_folder = folder_that_needs_splits()};
  const TetraResult result = fill(options, [](TetraResult&) {});
  EXPECT_THAT(log_, HasSubstr("trying TetGen with splits"));
  EXPECT_EQ(result.failures.size(), 2u);
  EXPECT_TRUE(result.is_reproducible);
  expect_tiling(as_split(domain_, result.splits), result);
  // Splits are forbidden, or there is no `taker` for them.
  TetraOptions never = options;
  never.boundary_splits = "never";
  EXPECT_THAT(error_info_of([&] { fill(never, [](TetraResult&) {}); }).problem, HasSubstr("signal 11"));
  EXPECT_THAT(error_info_of([&] { fill(options, {}); }).problem, HasSubstr("signal 11"));
}

TEST_F(FillWithSplits, ARefusalIsAFailureOfTheAttempt) {
  const auto refuse = [](TetraResult&) { throw Error({.code = ErrorCode::envelope_failed, .attempted = "following", .problem = "the layer cannot follow"}); };
  const TetraResult result = fill({.radius_edge = 1.2, .boundary_splits = "always"}, refuse);
  EXPECT_EQ(result.engine, "hxt");
  EXPECT_THAT(result.failures, ElementsAre(HasSubstr("cannot follow")));
  EXPECT_EQ(error_info_of([&] { fill({.radius_edge = 1.2, .boundary_splits = "always", .try_other_engine = false}, refuse); }).code,
            ErrorCode::envelope_failed);
}

TEST_F(FillWithSplits, ContradictionsAreNamed) {
  EXPECT_THAT(error_info_of([&] { fill({.boundary_splits = "always"}, {}); }).hint, HasSubstr("set boundary_splits = \"ladder\""));
  EXPECT_THAT(error_info_of([&] { fill({.engine = "hxt", .boundary_splits = "always"}, [](TetraResult&) {}); }).hint,
              HasSubstr("HXT cannot split the boundary"));
  EXPECT_EQ(error_info_of([&] { fill({.boundary_splits = "sometimes"}, {}); }).code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace sterna::volmesh
