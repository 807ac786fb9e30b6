// The envelope has no needles and no narrow folds that the wall does not have, on generated and real walls; derivatives of the corresponding terms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geom/math/measures.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/corner_shape.h"
#include "volmesh/envelope/edge_fold.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

constexpr double k_one_degree = std::numbers::pi / 180.0;

std::array<double, 3> sines_of(const std::array<Point, 3>& p) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[0];
  return corner_sines(a, b, norm(cross(a, b)));
}

/// Checks every triangle that is not collapsed, with an independent measurement: folds by angles, where the product measures sines.
void expect_shapely(const TriMesh& wall, const EnvelopeOptions& options) {
  const LayerBase base(wall, k_context);
  const Envelope envelope = build_envelope(base, options, k_context);
  std::size_t n_prisms = 0;
  for (const TriangleId t : wall.triangles.ids()) {
    const TriangleVertices& v = wall.triangles[t];
    if (std::any_of(v.begin(), v.end(), [&](VertexId x) { return envelope.is_collapsed(x); })) continue;
    ++n_prisms;
    std::array<Point, 3> below, top;
    for (std::size_t k = 0; k < 3; ++k) {
      below[k] = wall.points[v[k]];
      top[k] = envelope.point(wall, v[k]);
    }
    const std::array<double, 3> wall_sines = sines_of(below), top_sines = sines_of(top);
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_GE(top_sines[k], std::min(std::sin(12.0 * k_one_degree), 0.5 * wall_sines[k]) * (1.0 - 1e-3)) << "triangle " << t.value();
    for (int corner = 0; corner < 3; ++corner) {
      const HalfedgeId h = halfedge(t, corner);
      if (base.topology.is_boundary(h)) continue;
      const VertexId apex = base.topology.to(next(base.topology.twin(h)));
      const std::size_t c = static_cast<std::size_t>(corner);
      const auto angle = [&](const std::array<Point, 3>& p, const Point& q) {  // between the triangles, from the fluid
        const Vec3 e = normalized(p[(c + 1) % 3] - p[c]);
        const auto off = [&](const Point& x) { return (x - p[c]) - dot(x - p[c], e) * e; };
        const Vec3 mine = off(p[(c + 2) % 3]), other = off(q), normal = cross(p[1] - p[0], p[2] - p[0]);
        const double between = angle_between(mine, other);
        return dot(other, normal) > 0.0 ? between : 2.0 * std::numbers::pi - between;
      };
      const double on_wall = angle(below, wall.points[apex]);
      ASSERT_GE(angle(top, envelope.point(wall, apex)), std::min(15.0 * k_one_degree, 0.5 * on_wall) * (1.0 - 1e-3)) << "triangle " << t.value();
    }
  }
  EXPECT_GT(n_prisms, wall.n_triangles() / 2);
}

EnvelopeOptions layers_of(double length) {
  EnvelopeOptions options;
  options.layers = 25;
  options.first_height = 1e-6 * length;
  options.max_thickness = 0.1 * length;
  return options;
}

TEST(EnvelopeShape, OfABlockAndASphere) {
  expect_shapely(test::cube(6), layers_of(1.0));
  expect_shapely(test::sphere(8), layers_of(2.0));
}

class RealEnvelopeShape : public testing::TestWithParam<const char*> {};

TEST_P(RealEnvelopeShape, HasNoAddedSliversAndFolds) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = io::read_surface_file(test::shared_data() / "surfaces/clean" / GetParam(), k_context);
  const TriMesh wall = surfmesh::stitch_surface({soup}, {}, k_context).mesh;
  expect_shapely(wall, layers_of(body_length(wall)));
}

INSTANTIATE_TEST_SUITE_P(Clean, RealEnvelopeShape,
                         testing::Values("vspgeom_geom2_geom2.stl", "pygeo_bwb.stl", "cgal_data_couplingdown.off", "caturbs_wing_wing.stl",
                                         "cgal_data_anchor_dense.off"));

TEST(EdgeFold, FluidAnglesAreHingeAngles) {
  for (double degrees = 4.0; degrees < 179.0; degrees += 7.0) {
    const double angle = degrees * k_one_degree;
    // The edge lies along x; one triangle lies in the plane z = 0 towards +y, with the fluid above; the other is turned up towards the first.
    const FoldPoints hinge = {Point{0, 0, 0}, Point{1, 0, 0}, Point{0.4, 1, 0}, Point{0.6, std::cos(angle), std::sin(angle)}};
    const Fold fold = fold_of(hinge);
    EXPECT_TRUE(fold.is_concave) << degrees;
    EXPECT_NEAR(fold.cosine, -std::cos(angle), 1e-12) << degrees;
    const FoldLimit flat;
    EXPECT_EQ(fold_slack(fold, flat) > 0.0, degrees > 15.0) << degrees;
    EXPECT_EQ(fold_slack(fold, flat) < 1.0, degrees < 40.0) << degrees;
    // Over a wall with the same angle, half of that angle is allowed, and the term vanishes.
    const FoldLimit own = fold_limit(hinge);
    EXPECT_NEAR(fold_slack(fold, own), 1.0, 1e-9) << degrees;
  }
}

TEST(EdgeFold, TrianglesKeepSidesInConcaveCorner) {
  const double angle = 20.0 * k_one_degree;
  const FoldPoints above = {Point{0, 0, 0}, Point{1, 0, 0}, Point{0.4, 1, 0}, Point{0.6, std::cos(angle), std::sin(angle)}};
  FoldPoints below = above;
  below[3].z = -below[3].z;
  EXPECT_LT(fold_slack(fold_of(below), fold_limit(above)), 0.0);
  EXPECT_EQ(fold_slack(fold_of(below), fold_limit(below)), 1.0);  // a sharp trailing edge
}

TEST(EdgeFold, GradientIsTheDifferenceQuotient) {
  const FoldPoints points = {Point{0, 0, 0.1}, Point{1, 0.1, 0}, Point{0.4, 1, 0.2}, Point{0.6, 0.7, 0.5}};
  const std::array<Vec3, 4> gradient = fold_gradient(points, fold_of(points));
  constexpr double k_step = 1e-6;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      FoldPoints up = points, down = points;
      up[k][axis] += k_step;
      down[k][axis] -= k_step;
      EXPECT_NEAR(gradient[k][axis], (fold_of(up).cosine - fold_of(down).cosine) / (2.0 * k_step), 1e-8) << k << " " << axis;
    }
}

}  // namespace
}  // namespace sterna::volmesh
