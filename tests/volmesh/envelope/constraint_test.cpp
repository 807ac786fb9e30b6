// Constraints of envelope vertices: projections, axes and surfaces, compared with hand calculations.
#include "volmesh/envelope/constraint.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

const std::array<Vec3, 5> k_directions = {{{1, 2, 3}, {-0.3, 0.7, 0.1}, {0, 1, 1e-9}, {1e-3, -5, 2}, {-1, 0, 0}}};
const std::array<Vec3, 4> k_axes = {{{0, 1, 0}, {0, 0, -1}, normalized(Vec3{1, 2, 3}), normalized(Vec3{-1, 1e-3, 0})}};

TEST(Constraint, PlaneProjectsIntoItselfAndAxisPlanesExactly) {
  for (const Vec3& axis : k_axes)
    for (const Vec3& d : k_directions) {
      const Vec3 p = constrained({Freedom::plane, axis}, d);
      if (norm2(p) == 0.0) continue;
      EXPECT_NEAR(norm(p), 1.0, 1e-15);
      EXPECT_NEAR(dot(p, axis), 0.0, 1e-12);
      EXPECT_GE(dot(p, d), 0.0);
    }
  for (const Vec3& d : k_directions) {
    EXPECT_EQ(constrained({Freedom::plane, {0, 1, 0}}, d).y, 0.0);
    EXPECT_EQ(constrained({Freedom::surface, {0, 0, -1}}, d).z, 0.0);
  }
  EXPECT_EQ(norm2(constrained({Freedom::plane, {0, 1, 0}}, {0, 3, 0})), 0.0);
}

TEST(Constraint, LineTakesTheNearerSenseFixedHasNone) {
  EXPECT_EQ(constrained({Freedom::line, {0, 0, 1}}, {5, 5, -0.1}), (Vec3{0, 0, -1}));
  EXPECT_EQ(constrained({Freedom::line, {0, 0, 1}}, {5, 5, 0.1}), (Vec3{0, 0, 1}));
  EXPECT_EQ(norm2(constrained({Freedom::line, {0, 0, 1}}, {1, 0, 0})), 0.0);
  EXPECT_EQ(norm2(constrained({Freedom::fixed}, {1, 0, 0})), 0.0);
  EXPECT_NEAR(norm(constrained({}, {3, 4, 0})), 1.0, 1e-15);
}

TEST(Constraint, TangentAxesAreOrthonormalInsideTheConstraint) {
  for (const Vec3& axis : k_axes)
    for (const Vec3& d : k_directions) {
      for (const Freedom freedom : {Freedom::free, Freedom::plane, Freedom::surface, Freedom::line, Freedom::fixed}) {
        const VertexConstraint constraint{freedom, axis};
        const Vec3 normal = constrained(constraint, d);
        const TangentAxes tangent = tangent_axes(constraint, normal);
        ASSERT_EQ(tangent.count, tangential_unknowns(constraint));
        if (norm2(normal) == 0.0) continue;
        for (int i = 0; i < tangent.count; ++i) {
          const Vec3& t = tangent.axis[static_cast<std::size_t>(i)];
          EXPECT_NEAR(norm(t), 1.0, 1e-14);
          EXPECT_NEAR(dot(t, normal), 0.0, 1e-14);
          if (freedom != Freedom::free) {
            EXPECT_NEAR(dot(t, axis), 0.0, 1e-14);
          }
        }
        if (tangent.count == 2) {
          EXPECT_NEAR(dot(tangent.axis[0], tangent.axis[1]), 0.0, 1e-14);
        }
      }
    }
  EXPECT_EQ(tangential_unknowns({Freedom::free}), 2);
  EXPECT_EQ(tangential_unknowns({Freedom::plane}), 1);
  EXPECT_EQ(tangential_unknowns({Freedom::line}), 0);
  EXPECT_EQ(tangent_axes({Freedom::plane, {0, 1, 0}}, constrained({Freedom::plane, {0, 1, 0}}, {0.3, 0.1, 0.7})).axis[0].y, 0.0);
}

TEST(ConstraintSurface, PlaneCylinderAndTrianglesAgreeWithHand) {
  const ConstraintPlane plane({1, 2, 3}, {0, 2, 0});
  EXPECT_EQ(plane.inside_distance({9, 5, 9}), 3.0);
  EXPECT_EQ(plane.closest({9, 5, 9}), (Vec3{9, 2, 9}));
  const ConstraintCylinder tunnel({0, 0, 0}, {2, 0, 0}, 2.0);
  EXPECT_NEAR(tunnel.inside_distance({7, 0.6, 0.8}), 1.0, 1e-15);
  EXPECT_LT(distance(tunnel.closest({7, 0.6, 0.8}), {7, 1.2, 1.6}), 1e-15);
  EXPECT_LT(distance(tunnel.normal({7, 0.6, 0.8}), {0, -0.6, -0.8}), 1e-15);
  const ConstraintCylinder post({0, 0, 0}, {1, 0, 0}, 2.0, true);
  EXPECT_NEAR(post.inside_distance({7, 0.6, 0.8}), -1.0, 1e-15);
  // The outside of a fine sphere: all results are within the sagitta of the exact sphere.
  const ConstraintTriangles sphere(test::sphere(24), k_context);
  for (const Vec3& d : k_directions) {
    const Point p = 1.5 * normalized(d);
    EXPECT_NEAR(sphere.inside_distance(p), 0.5, 4e-3);
    EXPECT_NEAR(sphere.inside_distance(0.5 * normalized(d)), -0.5, 4e-3);
    EXPECT_LT(distance(sphere.closest(p), normalized(d)), 0.05);
    EXPECT_LT(angle_between(sphere.normal(p), d), 0.1);
  }
}

}  // namespace
}  // namespace sterna::volmesh
