// Smooth heights and the room above them: l_j of eq. (1), the membrane, the distance kept by the layer top.
#include <gtest/gtest.h>

#include <cmath>

#include "geom/mesh/bvh.h"
#include "geom/mesh/layer_room.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/keep_distance.h"
#include "volmesh/envelope/layer_objective.h"
#include "volmesh/envelope/optimise.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

EnvelopeOptions layers_of(double h0, int n, double thickness) {
  EnvelopeOptions options;
  options.first_height = h0;
  options.max_growth = 1.4;  // the law of eq. (1); uniform growth has separate tests
  options.growth = "local";
  options.layers = n;
  options.max_thickness = thickness;
  return options;
}

/// A sphere whose vertices are moved randomly along the surface by up to `share` of an edge: irregular triangles, as in imported surfaces.
TriMesh uneven_sphere(int n, double share) {
  TriMesh mesh = test::sphere(n);
  const double edge = distance(mesh.points[mesh.triangles[TriangleId(0)][0]], mesh.points[mesh.triangles[TriangleId(0)][1]]);
  std::uint32_t state = 12345;
  const auto chance = [&state] {
    state = 1664525u * state + 1013904223u;
    return state / 4294967296.0 - 0.5;
  };
  for (Point& p : mesh.points) {
    const Vec3 aside{chance(), chance(), chance()};
    p = normalized(p + 2.0 * share * edge * aside);
  }
  return mesh;
}

/// Returns the standard deviation of a column divided by its mean.
double relative_scatter(const Column<VertexId, double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const VertexId v : values.ids()) {
    sum += values[v];
    squares += values[v] * values[v];
  }
  const double n = static_cast<double>(values.size()), mean = sum / n;
  return std::sqrt(std::max(0.0, squares / n - mean * mean)) / mean;
}

TEST(LayerEdge, FollowsTheSurfaceAndNotSingleTriangles) {
  const TriMesh wall = uneven_sphere(16, 0.3);
  const LayerBase base(wall, k_context);
  EXPECT_GT(relative_scatter(base.mean_edge), 0.05);
  EXPECT_LT(relative_scatter(base.layer_edge), 0.6 * relative_scatter(base.mean_edge));
  const Envelope envelope = initial_envelope(base, layers_of(1e-4, 20, 10.0), k_context);
  EXPECT_LT(relative_scatter(envelope.target), 0.03);
}

TEST(LayerEdge, StretchedTrianglesGiveEqualAreaEdgeOrThird) {
  for (const double stretch : {1.0, 4.0, 40.0}) {
    TriMesh wall = test::cube(8);
    for (Point& p : wall.points) p.x *= stretch;
    const LayerBase base(wall, k_context);
    for (const VertexId v : wall.points.ids()) {
      if (std::abs(wall.points[v].x - 0.5 * stretch) > 0.13 * stretch) continue;  // vertices of the long sides only
      EXPECT_LE(base.layer_edge[v], 1.001 * base.mean_edge[v]);
      EXPECT_GE(base.layer_edge[v], 0.2 * base.mean_edge[v]);  // a third, smoothed with the short edges at the ends
    }
  }
  // The same body at another scale has the same edges at that scale.
  TriMesh large = test::cube(6);
  const LayerBase unit_base(large, k_context);
  const Column<VertexId, double> unit = unit_base.layer_edge;
  for (Point& p : large.points) p = 1000.0 * p;
  const LayerBase large_base(large, k_context);
  for (const VertexId v : large.points.ids()) EXPECT_NEAR(large_base.layer_edge[v], 1000.0 * unit[v], 1e-9 * large_base.layer_edge[v]);
}

double mean_square_slope(const LayerBase& base, const Envelope& envelope) {
  double sum = 0.0, n = 0.0;
  for (const VertexId v : base.wall.points.ids())
    for (const VertexId w : base.topology.neighbours(v)) {
      const double rise =
          dot(envelope.height[v] * envelope.direction[v], base.vertex_normal[v]) - dot(envelope.height[w] * envelope.direction[w], base.vertex_normal[w]);
      sum += rise * rise / norm2(base.wall.points[v] - base.wall.points[w]);
      n += 1.0;
    }
  return sum / n;
}

TEST(Membrane, EvensHeightsWithinBoundsAtLittleCost) {
  const TriMesh wall = test::sphere(10);
  const LayerBase base(wall, k_context);
  EnvelopeOptions options = layers_of(1e-3, 10, 10.0);
  Envelope start = initial_envelope(base, options, k_context);
  for (const VertexId v : wall.points.ids()) {
    start.height[v] = (v.value() % 3 == 0 ? 0.08 : 0.1);
    start.target[v] = start.cap[v] = start.height[v];
  }
  const auto optimised = [&](double membrane) {
    OptimiseSettings settings;
    settings.weights.membrane = membrane;
    settings.max_evaluations = 30;
    OptimiseReport report;
    Envelope result = optimise(base, start, upper_heights(base, start), 1e-3, settings, report, k_context);
    for (std::size_t i = 1; i < report.history.size(); ++i) EXPECT_LE(report.history[i].total, report.history[i - 1].total * (1.0 + 1e-12));
    return result;
  };
  const Envelope without = optimised(0.0), with = optimised(100.0);
  EXPECT_LT(mean_square_slope(base, with), 0.5 * mean_square_slope(base, without));
  double height = 0.0, before = 0.0;
  for (const VertexId v : wall.points.ids()) {
    height += with.height[v];
    before += start.height[v];
  }
  EXPECT_GT(height, 0.85 * before);
}

TriMesh two_spheres(int n, double gap) {
  TriMesh mesh = test::sphere(n), other = test::sphere(n);
  for (Point& p : other.points) p = p + Vec3{2.0 + gap, 0.0, 0.0};
  append(mesh, other);
  return mesh;
}

TEST(KeepDistance, TheTopStaysAwayFromWhatItFaces) {
  const TriMesh wall = two_spheres(12, 0.2);
  const LayerBase base(wall, k_context);
  const EnvelopeOptions options = layers_of(1e-4, 20, 0.5);
  const Envelope envelope = build_envelope(base, options, k_context);
  Collider collider(base, nullptr, k_context);
  EXPECT_TRUE(certify_envelope(base, collider, envelope, k_context).is_proved());
  TriMesh other;
  other.patches = wall.patches;
  for (const VertexId v : wall.points.ids()) other.points.push_back(envelope.point(wall, v));
  const std::size_t half = wall.n_vertices() / 2;
  for (const TriangleId t : wall.triangles.ids()) {
    if (wall.triangles[t][0].index() < half) continue;
    other.triangles.push_back(wall.triangles[t]);
    other.triangle_patch.push_back(PatchId(0));
  }
  const TriangleTree tree(other, k_context);
  int n_near = 0;
  for (std::size_t i = 0; i < half; ++i) {
    const VertexId v(i);
    const Point p = envelope.point(wall, v);
    if (dot(envelope.direction[v], Vec3{1, 0, 0}) < 0.9) continue;  // vertices that face the other body
    const double kept = std::min(k_kept_edges * envelope_edge(base, envelope, v), k_kept_share * 0.2);
    const double distance = tree.nearest(p).distance;
    EXPECT_GE(distance, 0.9 * kept);
    n_near += distance < 3.0 * kept;
  }
  EXPECT_GT(n_near, 0) << "the case is meant to have layers that meet";
}

TEST(KeepDistance, ChangesNothingWhereThereIsRoom) {
  const TriMesh wall = two_spheres(8, 3.0);
  const LayerBase base(wall, k_context);
  const EnvelopeOptions options = layers_of(1e-4, 15, 0.3);
  Envelope envelope = build_envelope(base, options, k_context);
  const Column<VertexId, double> before = envelope.height;
  Collider collider(base, nullptr, k_context);
  keep_distance(base, options, collider, envelope, k_context);
  EXPECT_EQ(envelope.height, before);
}

TEST(KeepDistance, SameBytesForAnyNumberOfThreads) {
  const TriMesh wall = two_spheres(10, 0.1);
  std::vector<Column<VertexId, double>> heights;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    const LayerBase base(wall, context);
    heights.push_back(build_envelope(base, layers_of(1e-4, 20, 0.5), context).height);
  }
  EXPECT_EQ(heights[0], heights[1]);
  EXPECT_EQ(heights[0], heights[2]);
}

}  // namespace
}  // namespace sterna::volmesh
