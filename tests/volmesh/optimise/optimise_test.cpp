// Our optimiser: objective compared with hand-calculated values, derivatives with central differences, runs with the documented guarantees.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/math/measures.h"
#include "tests/support/test_constants.h"
#include "tests/volmesh/optimise/rough_envelope.h"
#include "volmesh/envelope/optimise.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

double smallest_quality(const LayerBase& base, const Envelope& envelope) {
  double least = 1.0;
  for (const TriangleId t : base.wall.triangles.ids()) {
    const MacroElement e = macro_element(base, envelope, t);
    WedgePoints p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = e.wall[k];
      p[k + 3] = e.wall[k] + e.height[k] * e.direction[k];
    }
    least = std::min(least, wedge_quality(p));
  }
  return least;
}

TEST(LayerObjective, CubeByHand) {
  // Every growth line of a cube of 12 triangles leaves its corner along a space diagonal: its cosine with each face, at the wall and at the envelope (a larger
  // cube), is 1/sqrt(3). Heights are 0.8 of the bound.
  const TriMesh cube = test::cube(1);
  const LayerBase base(cube, k_context);
  Envelope envelope;
  const double diagonal = 1.0 / std::sqrt(3.0);
  for (const VertexId v : cube.points.ids()) {
    const Point& p = cube.points[v];
    envelope.direction.push_back({p.x > 0.5 ? diagonal : -diagonal, p.y > 0.5 ? diagonal : -diagonal, p.z > 0.5 ? diagonal : -diagonal});
    envelope.height.push_back(0.08);
  }
  envelope.target.assign(8, 0.1);
  envelope.cap.assign(8, 0.1);
  envelope.limit.assign(8, HeightLimit::none);
  LayerObjective objective(base, envelope, envelope.target, 1e-6, 0.0, {}, k_context);
  const ObjectiveValue value = objective.evaluate(objective.unknowns(envelope), k_context);
  EXPECT_EQ(objective.n_moving(), 8u);
  EXPECT_NEAR(value.f1, 1.0 - diagonal, 1e-14);
  EXPECT_NEAR(value.f3, 1.0 - diagonal, 1e-14);
  double mean_rise = 0.0;  // the angle-weighted normals at the corners of a cube are its space diagonals
  for (const VertexId v : cube.points.ids()) mean_rise += dot(base.vertex_normal[v], envelope.direction[v]) / 8.0;
  EXPECT_NEAR(value.f2, 1.0 - 0.8 * mean_rise, 1e-14);
  EXPECT_EQ(value.barrier, 0.0);
}

/// Returns the element of the wall triangle; corner 0 of its growth edges is moved by `displacement`, m.
LayerElement layer_element(const LayerBase& base, const Envelope& envelope, TriangleId t, const Vec3& displacement) {
  const MacroElement macro = macro_element(base, envelope, t);
  std::array<Vec3, 3> growth;
  for (std::size_t k = 0; k < 3; ++k) growth[k] = macro.height[k] * macro.direction[k];
  growth[0] += displacement;
  LayerElement e;
  e.n_wall = base.unit_normal[t];
  e.wall_area2 = 2.0 * base.area[t];
  for (std::size_t k = 0; k < 3; ++k) e.set_growth(k, growth[k]);
  for (std::size_t k = 0; k < 2; ++k) {
    e.e[k] = macro.wall[k + 1] - macro.wall[0];
    e.top[k] = e.e[k] + growth[k + 1] - growth[0];
  }
  e.set_corners();
  return e;
}

class ElementGradient : public testing::TestWithParam<ElementWeights> {};

TEST_P(ElementGradient, MatchesCentralDifferencesAtSecondOrder) {
  const TriMesh sphere = hollow_sphere(6);
  const LayerBase base(sphere, k_context);
  const Envelope envelope = rough_envelope(base, thick_layers(), 0.3, 0.4, k_context);
  Noise noise;
  double slopes = 0.0, coarse = 0.0, fine = 0.0, energies = 0.0;
  for (const TriangleId t : sphere.triangles.ids()) {
    const Vec3 direction = noise.vector();
    const auto energy_at = [&](double step) {
      LayerElement e = layer_element(base, envelope, t, step * direction);
      e.measure();
      return e.energy(GetParam());
    };
    LayerElement e = layer_element(base, envelope, t, {});
    if (e.measure() < 0.1) continue;  // where a barrier is steep, errors of higher order would mask the order
    Vec3 gradient;
    SymmetricBlock hessian;
    e.differentiate_corner_0(GetParam(), gradient, hessian);
    const double slope = dot(gradient, direction);
    const auto error_at = [&](double step) { return std::abs((energy_at(step) - energy_at(-step)) / (2.0 * step) - slope); };
    energies += e.energy(GetParam());
    slopes += std::abs(slope);
    coarse += error_at(4e-5);
    fine += error_at(2e-5);
  }
  ASSERT_GT(energies, 0.0) << "the energy must be active to be tested";
  EXPECT_LT(fine, 1e-4 * slopes);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);  // second order: half the step gives a quarter of the error; 10 % allows for the next order
}

INSTANTIATE_TEST_SUITE_P(Terms, ElementGradient,
                         testing::Values(ElementWeights{.top = 1.0, .barrier = 0.0}, ElementWeights{.top = 0.0, .barrier = 1.0},
                                         ElementWeights{.top = 0.3, .barrier = 0.02}));

TEST(Optimise, ObjectiveFallsMonotonicallyAndElementsStayValid) {
  const TriMesh sphere = hollow_sphere(12);
  const LayerBase base(sphere, k_context);
  const EnvelopeOptions options = thick_layers();
  const Envelope start = rough_envelope(base, options, 0.4, 0.5, k_context);
  OptimiseSettings settings;
  settings.max_evaluations = 60;
  OptimiseReport report;
  const Envelope result = optimise(base, start, upper_heights(base, start), options.first_height, settings, report, k_context);
  ASSERT_GT(report.history.size(), 1u);
  for (std::size_t i = 1; i < report.history.size(); ++i) EXPECT_LE(report.history[i].total, report.history[i - 1].total);
  EXPECT_LE(report.n_evaluations, settings.max_evaluations);
  EXPECT_TRUE(invalid_macros(base, result, k_context).empty());
  EXPECT_GE(smallest_quality(base, result), 0.9 * smallest_quality(base, start) * (1.0 - 1e-12));
  // On a sphere the optimal growth lines are the normals at full height.
  double tilt = 0.0, share = 0.0;
  for (const VertexId v : result.height.ids()) {
    tilt += angle_between(result.direction[v], base.vertex_normal[v]);
    share += result.height[v] / start.target[v];
  }
  const double n = static_cast<double>(result.height.size());
  EXPECT_LT(tilt / n, 3.0 * std::numbers::pi / 180.0);
  EXPECT_GT(share / n, 0.97);
}

TEST(Optimise, SameBytesForAnyNumberOfThreads) {
  const TriMesh sphere = hollow_sphere(24);
  const LayerBase base(sphere, k_context);
  const EnvelopeOptions options = thick_layers();
  const Envelope start = rough_envelope(base, options, 0.3, 0.5, k_context);
  OptimiseSettings settings;
  settings.max_evaluations = 12;
  std::vector<Envelope> results;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    OptimiseReport report;
    results.push_back(optimise(base, start, upper_heights(base, start), options.first_height, settings, report, context));
  }
  for (const Envelope& other : results) {
    EXPECT_EQ(other.height, results.front().height);
    EXPECT_EQ(other.direction, results.front().direction);
  }
}

TEST(Optimise, ConstrainedVerticesStayInPlaneOrOnLine) {
  const TriMesh cube = test::cube(4);
  Constraints constraints;
  constraints.vertex.resize(cube.n_vertices());
  VertexId in_plane, on_line, fixed;
  for (const VertexId v : cube.points.ids()) {
    const Point& p = cube.points[v];
    if (p.z != 1.0 || p.x == 0.0 || p.x == 1.0 || p.y == 0.0 || p.y == 1.0) continue;
    if (p.x == 0.5 && p.y == 0.5) constraints.vertex[in_plane = v] = {Freedom::plane, {0, 1, 0}};
    if (p.x == 0.25 && p.y == 0.25) constraints.vertex[on_line = v] = {Freedom::line, {0, 0, 1}};
    if (p.x == 0.75 && p.y == 0.25) constraints.vertex[fixed = v] = {Freedom::fixed, {}};
  }
  ASSERT_TRUE(in_plane.is_valid() && on_line.is_valid() && fixed.is_valid());
  const LayerBase base(cube, k_context, constraints);
  Envelope start = initial_envelope(base, thick_layers(), k_context);
  start.direction[in_plane] = normalized(Vec3{0.3, 0.0, 1.0});
  start.direction[on_line] = {0, 0, 1};
  OptimiseReport report;
  const Envelope result = optimise(base, start, upper_heights(base, start), 1e-4, {}, report, k_context);
  EXPECT_EQ(result.direction[in_plane].y, 0.0);
  EXPECT_LT(std::abs(result.direction[in_plane].x), 0.05);
  EXPECT_EQ(result.direction[on_line], (Vec3{0, 0, 1}));
  EXPECT_TRUE(start.is_collapsed(fixed) && result.is_collapsed(fixed));
}

}  // namespace
}  // namespace sterna::volmesh
