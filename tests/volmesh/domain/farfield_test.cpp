#include "volmesh/domain/farfield.h"

#include <gmock/gmock.h>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "tests/support/test_shapes.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

ErrorInfo sphere_error(const TriMesh& wall, const FarfieldOptions& options) {
  try {
    farfield_sphere(wall, options, RunContext{});
  } catch (const Error& error) {
    return error.info();
  }
  return {};
}

using test::volume_of;

TEST(FarfieldSphere, IsClosedInwardAndRound) {
  const TriMesh wall = test::cube(2);
  for (const double edge : {100.0, 30.0, 20.0, 11.0, 4.0}) {
    const TriMesh sphere = farfield_sphere(wall, {.farfield_edge = edge}, RunContext{});
    const Topology topology(sphere, RunContext{});
    EXPECT_EQ(topology.n_boundary_halfedges(), 0u);
    EXPECT_EQ(sphere.n_vertices(), sphere.n_triangles() / 2 + 2);  // Euler
    EXPECT_EQ(connected_components(sphere, topology).count, 1u);
    EXPECT_LT(volume_of(sphere), 0.0);
    for (const Point& p : sphere.points) EXPECT_NEAR(distance(p, {0.5, 0.5, 0.5}), 50.0, 1e-12 * 50.0);
    ASSERT_EQ(sphere.patches.size(), 1u);
    EXPECT_EQ(sphere.patches[PatchId(0)], (Patch{"farfield", PatchKind::farfield}));
    EXPECT_EQ(sphere.triangle_patch.size(), sphere.n_triangles());
  }
}

TEST(FarfieldSphere, HasTheEdgeLengthAskedFor) {
  const TriMesh wall = test::cube(1);
  for (const double edge : {20.0, 10.0, 5.0}) {
    const TriMesh sphere = farfield_sphere(wall, {.farfield_edge = edge}, RunContext{});
    double sum = 0.0, least = 1e300, most = 0.0;
    for (const TriangleVertices& t : sphere.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double length = distance(sphere.points[t[k]], sphere.points[t[(k + 1) % 3]]);
        sum += length;
        least = std::min(least, length);
        most = std::max(most, length);
      }
    }
    const double mean = sum / (3.0 * static_cast<double>(sphere.n_triangles()));
    EXPECT_NEAR(mean / edge, 1.1, 0.15);  // projection to the sphere lengthens edges, by up to 1.26 in the middle of a face
    EXPECT_LT(most / least, 1.5);         // for class I subdivision: 1.41 for f = 21, growing slowly with f
  }
}

TEST(FarfieldSphere, DefaultsToFiftyBodyLengthsAnd500Triangles) {
  TriMesh wall = test::cube(1);
  for (Point& p : wall.points) p = {4.0 * p.x + 7.0, p.y, p.z};
  const TriMesh sphere = farfield_sphere(wall, {}, RunContext{});
  EXPECT_EQ(sphere.n_triangles(), 500u);
  EXPECT_NEAR(bounding_box(sphere).longest_side(), 400.0, 0.01 * 400.0);  // no vertex has to lie on an axis
  EXPECT_NEAR(bounding_box(sphere).center().x, 9.0, 1e-9);
}

TEST(FarfieldSphere, MustEncloseTheWall) {
  const TriMesh wall = test::cube(1);
  for (const double radius : {0.1, 0.86, 1.1}) {
    const ErrorInfo error = sphere_error(wall, {.farfield_radius = radius});
    EXPECT_EQ(error.code, ErrorCode::bad_argument);
    EXPECT_THAT(error.problem, HasSubstr("reach out to"));
    EXPECT_EQ(error.locations.size(), 1u);
  }
  EXPECT_NO_THROW(farfield_sphere(wall, {.farfield_radius = 1.2}, RunContext{}));
  // A coarse sphere is flat: its triangles come much nearer to the centre than its radius.
  EXPECT_EQ(sphere_error(wall, {.farfield_radius = 1.2, .farfield_edge = 10.0}).code, ErrorCode::bad_argument);
}

TEST(FarfieldSphere, RejectsSillyInput) {
  EXPECT_EQ(sphere_error(TriMesh{}, {}).code, ErrorCode::empty_surface);
  EXPECT_THAT(sphere_error(test::cube(1), {.farfield_edge = 1e-6}).problem, HasSubstr("triangles"));
}

}  // namespace
}  // namespace sterna::volmesh
