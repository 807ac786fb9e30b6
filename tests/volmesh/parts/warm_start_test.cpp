// An envelope that starts from that of the same wall in another shape: valid, proved, of equal height; refused if layer height is lost.
#include "volmesh/parts/warm_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geom/model/frame.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/certificate.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

using test::k_context;

EnvelopeOptions eight_layers() {
  EnvelopeOptions options;
  options.first_height = 5e-3;
  options.layers = 8;
  options.max_thickness = 0.1;  // not a share of the bounding box, which turns with the wall
  return options;
}

StartingEnvelope start_of(const TriMesh& wall) {
  const LayerBase base(wall, k_context);
  return {wall.points, build_envelope(base, eight_layers(), k_context)};
}

TriMesh mapped(TriMesh wall, const std::function<Point(const Point&)>& map) {
  for (Point& p : wall.points) p = map(p);
  return wall;
}

struct Started {
  WarmStart start;
  bool is_proved = false;
  Envelope from_scratch;
};
Started started(const TriMesh& wall, const StartingEnvelope& from, const EnvelopeOptions& options = eight_layers(), const RunContext& context = k_context) {
  const LayerBase base(wall, context);
  Collider collider(base, nullptr, context);
  Started result{warm_start(base, options, from, collider, context)};
  if (result.start.envelope) result.is_proved = certify_envelope(base, collider, *result.start.envelope, context).is_proved();
  result.from_scratch = build_envelope(base, options, collider, context);
  return result;
}

Point bend(const Point& p) { return {p.x, p.y + 0.15 * p.x * p.x, p.z}; }

TEST(WarmStart, BentWallsKeepStartHeightsAndAreProved) {
  for (const TriMesh& wall : {test::cube(6), test::sphere(6)}) {
    const StartingEnvelope from = start_of(wall);
    const Started result = started(mapped(wall, bend), from);
    ASSERT_TRUE(result.start.envelope) << result.start.objection;
    EXPECT_TRUE(result.is_proved);
    double area_share = 0.0;
    for (const VertexId v : wall.points.ids()) {
      const Envelope &was = from.envelope, &now = *result.start.envelope;
      EXPECT_GT(now.height[v], 0.0);
      area_share += now.height[v] / now.target[v] - was.height[v] / was.target[v];
      EXPECT_DOUBLE_EQ(now.target[v], result.from_scratch.target[v]);  // target is recomputed
    }
    EXPECT_GT(area_share / static_cast<double>(wall.n_vertices()), -0.02);
  }
}

TEST(WarmStart, DirectionsTurnWithTheWall) {
  const TriMesh wall = test::cube(4);
  const StartingEnvelope from = start_of(wall);
  const Transform turn = rotation({0.3, 0.1, 0.2}, normalized(Vec3{1, 2, 3}), 0.7);
  const Started result = started(mapped(wall, [&](const Point& p) { return turn.point(p); }), from);
  ASSERT_TRUE(result.start.envelope) << result.start.objection;
  for (const VertexId v : wall.points.ids()) {
    EXPECT_LT(norm(result.start.envelope->direction[v] - turn.vector(from.envelope.direction[v])), 1e-9);
    EXPECT_NEAR(result.start.envelope->height[v], from.envelope.height[v], 1e-9);
  }
}

TEST(WarmStart, HeightsFollowWhatIsAskedForHere) {
  const TriMesh wall = test::sphere(6);
  const StartingEnvelope from = start_of(wall);
  EnvelopeOptions thinner = eight_layers();
  thinner.first_height = 1e-3;
  thinner.layers = 5;
  const Started result = started(wall, from, thinner);
  ASSERT_TRUE(result.start.envelope) << result.start.objection;
  for (const VertexId v : wall.points.ids()) EXPECT_LE(result.start.envelope->height[v], 1.01 * result.start.envelope->target[v]);
}

TEST(WarmStart, IsRefusedWhereLayerWouldBeMuchLower) {
  // Two cubes so close to each other that their layers must share the gap.
  const auto cubes = [](double gap) {
    TriMesh both = test::cube(6);
    append(both, mapped(test::cube(6), [gap](const Point& p) { return Point{p.x + 1.0 + gap, p.y, p.z}; }));
    return both;
  };
  const StartingEnvelope from = start_of(cubes(2.0));
  EXPECT_TRUE(started(cubes(1.5), from).start.envelope);
  const Started near = started(cubes(0.05), from);
  EXPECT_FALSE(near.start.envelope);
  EXPECT_THAT(near.start.objection, HasSubstr("full height would be lost on "));
  EXPECT_GT(near.start.location.x, 0.9);
  EXPECT_LT(near.start.location.x, 1.2);
  const Started other = started(test::cube(5), from);
  EXPECT_FALSE(other.start.envelope);
  EXPECT_THAT(other.start.objection, HasSubstr("vertices"));
}

TEST(WarmStart, IsTheSameForAnyNumberOfThreads) {
  const TriMesh wall = test::sphere(8);
  const StartingEnvelope from = start_of(wall);
  const TriMesh bent = mapped(wall, bend);
  const Started one = started(bent, from, eight_layers(), RunContext({.threads = 1})), seven = started(bent, from, eight_layers(), RunContext({.threads = 7}));
  ASSERT_TRUE(one.start.envelope && seven.start.envelope);
  EXPECT_EQ(one.start.envelope->height.raw(), seven.start.envelope->height.raw());
  for (const VertexId v : wall.points.ids()) EXPECT_EQ(one.start.envelope->direction[v], seven.start.envelope->direction[v]);
}

}  // namespace
}  // namespace sterna::volmesh
