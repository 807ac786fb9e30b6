// Periodic sides: identical triangles on both sides, or an error if their loops differ.
#include "volmesh/adjacent/copy_translated.h"

#include <gmock/gmock.h>

#include "geom/base/error.h"
#include "tests/support/test_constants.h"
#include "tests/volmesh/adjacent/end_cases.h"

namespace sterna::volmesh {
namespace {

using namespace test_ends;

using test::k_context;
const ConstraintPlane k_left({0, 0, 0}, {0, 1, 0}), k_right({0, 0.3, 0}, {0, -1, 0});

AdjacentRegion left() {
  AdjacentRegion region{.surface = &k_left, .name = "left"};
  add_loop(region, rectangle(on_xz, -1, -1, 1, 1, 12, 12));
  add_loop(region, circle(on_xz, 0.1, 0.2, -0.3, 60));
  return region;
}

/// Returns the opposite side in reversed orientation: points in another order, edges reversed, moved by `noise`.
AdjacentRegion right(double noise) {
  const AdjacentRegion region = left();
  AdjacentRegion other{.surface = &k_right, .name = "right"};
  const auto n = static_cast<std::uint32_t>(region.points.size());
  for (std::uint32_t i = 0; i < n; ++i) other.points.push_back(region.points[n - 1 - i] + Vec3{noise * std::sin(i), 0.3, noise * std::cos(i)});
  for (const auto& edge : region.edges) other.edges.push_back({n - 1 - edge[1], n - 1 - edge[0]});
  return other;
}

TEST(CopyTranslated, PartnersHaveTheSameTrianglesTurnedOver) {
  const AdjacentRegion from = left(), to = right(1e-12);
  const AdjacentTriangles triangles = triangulate_adjacent(from, {}, k_context);
  const AdjacentTriangles copy = copy_translated(from, triangles, to, {0, 0.3, 0}, 1.0);
  const EndFacts facts = expect_sound(to, copy, 0.0);
  EXPECT_GT(facts.least_angle, 20.0);
  ASSERT_EQ(copy.new_points.size(), triangles.new_points.size());
  for (std::size_t i = 0; i < copy.new_points.size(); ++i) EXPECT_EQ(copy.new_points[i], (triangles.new_points[i] + Vec3{0, 0.3, 0}));
}

TEST(CopyTranslated, DifferentLoopsAreErrorWithLocations) {
  const AdjacentRegion from = left();
  const AdjacentTriangles triangles = triangulate_adjacent(from, {}, k_context);
  const auto failure = [&](const AdjacentRegion& to) {
    try {
      copy_translated(from, triangles, to, {0, 0.3, 0}, 1.0);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_THAT(error.info().attempted, testing::HasSubstr("\"right\""));
      EXPECT_FALSE(error.info().locations.empty());
      return error.info();
    }
    ADD_FAILURE() << "no error";
    return ErrorInfo{};
  };
  AdjacentRegion moved = right(0.0), turned = right(0.0);
  moved.points[5].x += 1e-9;
  EXPECT_EQ(failure(moved).n_locations, 2) << "the point of each side";
  EXPECT_LT(distance(failure(moved).locations[0].position, moved.points[5]), 1e-8);
  std::swap(turned.edges[3][0], turned.edges[3][1]);
  EXPECT_THAT(failure(turned).problem, testing::HasSubstr("edges"));
}

}  // namespace
}  // namespace sterna::volmesh
