// The stages of the envelope on shapes with hand-calculated results.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/mesh/find_crossings.h"
#include "tests/support/envelope_surface.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

EnvelopeOptions layers_of(double h0, int n) {
  EnvelopeOptions options;
  options.first_height = h0;
  options.max_growth = 1.4;  // the law of eq. (1); uniform growth has separate tests
  options.growth = "local";
  options.layers = n;
  return options;
}

VertexId vertex_at(const TriMesh& mesh, const Point& p) {
  for (const VertexId v : mesh.points.ids())
    if (distance(mesh.points[v], p) < 1e-12) return v;
  ADD_FAILURE() << "no vertex at " << p.x << " " << p.y << " " << p.z;
  return VertexId(0);
}

TEST(EdgeHeightLimits, LawOfSinesOfTheSpecification) {
  // docs/method/envelope.md, "Untangling": beta 80 and 60 degrees, |e| = 1: h1 < 1.347, h2 < 1.532.
  const double deg = std::numbers::pi / 180.0;
  const Vec3 d1 = {std::cos(80 * deg), std::sin(80 * deg), 0.0};
  const Vec3 d2 = {-std::cos(60 * deg), std::sin(60 * deg), 0.0};
  const auto [h1, h2] = edge_height_limits({0, 0, 0}, d1, {1, 0, 0}, d2);
  EXPECT_NEAR(h1, 1.347, 1e-3);
  EXPECT_NEAR(h2, 1.532, 1e-3);
  // At the limits the two envelope vertices coincide.
  EXPECT_LT(distance(h1 * d1, Vec3{1, 0, 0} + h2 * d2), 1e-12);
}

TEST(EdgeHeightLimits, DivergingLinesHaveNone) {
  const auto [h1, h2] = edge_height_limits({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, normalized(Vec3{0.1, 1, 0}));
  EXPECT_TRUE(std::isinf(h1) && std::isinf(h2));
}

TEST(Classification, CubeHasCornersRidgesAndSmoothFaces) {
  const TriMesh cube = test::cube(4);
  const LayerBase base(cube, k_context);
  const Classification classes = classify_vertices(base, {}, k_context);
  int n_corners = 0, n_ridges = 0;
  for (const VertexId v : cube.points.ids()) {
    const VertexClass& flags = classes.vertex[v];
    n_corners += flags.is_corner ? 1 : 0;
    n_ridges += flags.is_ridge ? 1 : 0;
    EXPECT_FALSE(flags.is_concave);
    EXPECT_EQ(flags.is_smooth(), !flags.is_convex);
    if (!flags.is_smooth()) {
      EXPECT_TRUE(flags.is_blunt && !flags.is_sharp);
    }
  }
  EXPECT_EQ(n_corners, 8);
  EXPECT_EQ(n_ridges, 12 * 3);
}

TEST(InitialEnvelope, CubeCornersGrowDiagonallySpheresRadially) {
  const TriMesh cube = test::cube(4);
  const LayerBase base(cube, k_context);
  const Envelope envelope = initial_envelope(base, layers_of(1e-4, 10), k_context);
  const Vec3 d = envelope.direction[vertex_at(cube, {1, 1, 1})];
  EXPECT_LT(distance(d, normalized(Vec3{1, 1, 1})), 1e-9);

  const TriMesh sphere = test::sphere(8);
  const LayerBase sphere_base(sphere, k_context);
  const Envelope around = initial_envelope(sphere_base, layers_of(1e-5, 20), k_context);
  for (const VertexId v : sphere.points.ids()) EXPECT_LT(angle_between(around.direction[v], sphere.points[v]), 0.02);
}

TEST(InitialEnvelope, TargetKeepsCapsAndSlope) {
  const TriMesh sphere = test::sphere(10);
  const LayerBase base(sphere, k_context);
  EnvelopeOptions options = layers_of(1e-5, 20);
  options.height_gradient = 0.1;
  options.max_thickness = 0.3;
  const Envelope envelope = initial_envelope(base, options, k_context);
  for (const VertexId v : sphere.points.ids()) {
    EXPECT_LE(envelope.target[v], std::min(0.3, envelope.eq1[v]));
    for (const VertexId other : base.topology.neighbours(v))
      EXPECT_LE(envelope.target[v] - envelope.target[other], 0.1 * distance(sphere.points[v], sphere.points[other]) * (1 + 1e-12));
  }
}

TEST(SmallestCap, ThreeMutuallyOrthogonalNormals) {
  const std::array<Vec3, 4> normals = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, normalized(Vec3{1, 1, 1})}};
  const Cap cap = smallest_cap(normals);
  EXPECT_NEAR(cap.cosine, 1.0 / std::sqrt(3.0), 1e-12);
  EXPECT_LT(distance(cap.axis, normals[3]), 1e-12);
}

TEST(Unwarp, TangledHeightsBecomeValidAndOnlyFall) {
  TriMesh cube = test::cube(6);
  for (const TriangleId t : cube.triangles.ids()) std::swap(cube.triangles[t][1], cube.triangles[t][2]);  // inside of a box: all corners are concave
  const LayerBase base(cube, k_context);
  const EnvelopeOptions options = layers_of(1e-4, 12);
  Envelope envelope = initial_envelope(base, options, k_context);
  for (double& h : envelope.height) h = 0.6;  // far too tall
  const Envelope before = envelope;
  EXPECT_FALSE(invalid_macros(base, envelope, k_context).empty());
  unwarp(base, options, HeightLimit::warp, envelope, k_context);
  EXPECT_TRUE(invalid_macros(base, envelope, k_context).empty());
  for (const VertexId v : cube.points.ids()) EXPECT_LE(envelope.height[v], before.height[v]);
}

TEST(BuildEnvelope, OpposingCubesShareGapWithoutCollision) {
  TriMesh two = test::cube(6);
  TriMesh other = two;
  for (Point& p : other.points) p.x += 1.1;  // gap of a tenth
  append(two, other);
  const LayerBase base(two, k_context);
  EnvelopeOptions options = layers_of(1e-4, 15);
  options.max_thickness = 0.2;
  const Envelope envelope = build_envelope(base, options, k_context);
  const test::EnvelopeSurface surface = test::envelope_surface(base, envelope, k_context);
  EXPECT_EQ(find_crossings(surface.points, surface.triangles, k_context).total, 0);
  const VertexId left = vertex_at(two, {1, 0.5, 0.5});
  const VertexId right = vertex_at(two, {1.1, 0.5, 0.5});
  EXPECT_LT(envelope.height[left] + envelope.height[right], 0.1);
  EXPECT_GT(envelope.height[left] + envelope.height[right], 0.05);
  const VertexId outer = vertex_at(two, {0, 0.5, 0.5});
  EXPECT_GE(envelope.height[outer], 0.9 * envelope.target[outer]);
}

TEST(BuildEnvelope, SameBytesForAnyNumberOfThreads) {
  const TriMesh cube = test::cube(8);
  std::vector<Envelope> results;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    results.push_back(build_envelope(LayerBase(cube, context), layers_of(1e-5, 20), context));
  }
  for (const Envelope& envelope : results) {
    EXPECT_EQ(envelope.height, results[0].height);
    EXPECT_EQ(envelope.direction, results[0].direction);
  }
}

}  // namespace
}  // namespace sterna::volmesh
