// Open boundaries that lie nearly in a plane are moved into it, with a message; others remain unchanged.
#include "volmesh/domain/flatten_borders.h"

#include <gmock/gmock.h>

#include <cmath>

#include "geom/base/error.h"
#include "geom/mesh/topology.h"
#include "tests/support/halves.h"
#include "tests/support/test_shapes.h"
#include "volmesh/domain/complete_boundary.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

/// Half a ball on the plane y = 0.2; vertices of its open boundary are off the plane by up to `off` of the length.
TriMesh half_with_waves(double off) {
  TriMesh half = test::cut_off(test::sphere(4), 1, 0.2);
  const Topology topology(half, RunContext());
  const double length = body_length(half);
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (topology.is_boundary(h) && i % 5 != 0) half.points[topology.from(h)].y += 0.5 * off * length * (1.0 + std::cos(double(i)));
  }
  return half;
}

TEST(FlattenRims, RimNearPlaneBecomesPlaneAndIsReported) {
  std::vector<std::string> reported;
  RunSettings settings;
  settings.log = [&](LogLevel, std::string_view text) { reported.emplace_back(text); };
  const RunContext context(settings);
  const TriMesh closed = complete_boundary(half_with_waves(0.9e-4), {}, context);
  EXPECT_EQ(Topology(closed, context).n_boundary_halfedges(), 0u);
  EXPECT_THAT(reported,
              testing::Contains(testing::AllOf(HasSubstr("lies near, but not in, the plane y = 0.2"), HasSubstr("were moved into the plane, by up to"))));
  TriMesh half = half_with_waves(0.9e-4);
  const Topology topology(half, context);
  flatten_borders(topology, half, context);
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i)
    if (topology.is_boundary(HalfedgeId(i))) EXPECT_EQ(half.points[topology.from(HalfedgeId(i))].y, 0.2);
}

TEST(FlattenRims, RimFartherFromPlaneIsRefused) {
  try {
    complete_boundary(half_with_waves(1e-3), {}, RunContext());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::open_surface);
    EXPECT_THAT(error.what(), HasSubstr("lie in no plane x, y or z = constant"));
  }
}

}  // namespace
}  // namespace sterna::volmesh
