// The published problem: values worked by hand, gradients against central differences, and both NLopt solvers on it.
#include <gtest/gtest.h>

#include <cmath>

#include "geom/base/error.h"
#include "io/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/volmesh/optimise/rough_envelope.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/nlopt_optimise.h"
#include "volmesh/envelope/paper_problem.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

const RunContext k_context({.threads = 2});

TEST(PaperProblem, CubeByHand) {
  // As LayerObjective.CubeByHand; one envelope vertex is then drawn through its cube.
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
  PaperProblem problem(base, envelope, envelope.target, 1e-6, k_context);
  EXPECT_EQ(problem.n_variables(), 24u);
  std::vector<double> z = problem.variables(envelope);
  const ObjectiveValue value = problem.objective(z.data(), nullptr, k_context);
  EXPECT_NEAR(value.f1, 1.0 - diagonal, 1e-14);
  EXPECT_EQ(problem.inversion(z.data(), nullptr, k_context).n_violated, 0);
  EXPECT_EQ(problem.below_wall(z.data(), nullptr, k_context).n_violated, 0);
  // Growth vector of the first vertex along minus its diagonal, 0.08 long: y = -0.8 diagonal, and every incident face is missed by 0.8/sqrt(3).
  std::int64_t n_incident = 0;
  Envelope drawn = envelope;
  drawn.direction[VertexId(0)] = -drawn.direction[VertexId(0)];
  for (const TriangleVertices& t : cube.triangles) n_incident += t[0] == VertexId(0) || t[1] == VertexId(0) || t[2] == VertexId(0);
  const auto y0 = drawn.height[VertexId(0)] / 0.1;
  z = problem.variables(drawn);  // heights are clamped to their lower bound, so write the first vertex's by hand
  Envelope restored = envelope;
  problem.store(z.data(), restored);
  const double height_share = dot(restored.height[VertexId(0)] * restored.direction[VertexId(0)], base.vertex_normal[VertexId(0)]) / 0.1;
  EXPECT_NEAR(height_share, problem.lower()[2], 1e-12);
  z[2] = dot(y0 * drawn.direction[VertexId(0)], base.vertex_normal[VertexId(0)]);
  const ConstraintSum below = problem.below_wall(z.data(), nullptr, k_context);
  EXPECT_EQ(below.n_violated, n_incident);
  EXPECT_NEAR(below.sum, static_cast<double>(n_incident) * 0.8 * diagonal, 1e-12);
}

class PaperGradient : public testing::TestWithParam<int> {};

TEST_P(PaperGradient, MatchesCentralDifferencesAtSecondOrder) {
  const TriMesh sphere = hollow_sphere(6);
  const LayerBase base(sphere, k_context);
  const EnvelopeOptions options = thick_layers();
  Envelope envelope = rough_envelope(base, options, 0.3, 0.4, k_context);
  PaperProblem problem(base, envelope, envelope.target, options.first_height, k_context);
  std::vector<double> z = problem.variables(envelope), gradient(z.size()), direction(z.size());
  Noise noise;
  // Strongly tilted and folded, so that both constraints are violated at many elements.
  if (GetParam() > 0)
    for (double& value : z) value += 4.0 * noise.next();
  for (double& value : direction) value = noise.next();
  const auto value_at = [&](const std::vector<double>& at, double* g) {
    if (GetParam() == 0) return problem.objective(at.data(), g, k_context).total;
    const ConstraintSum sum = GetParam() == 1 ? problem.inversion(at.data(), g, k_context) : problem.below_wall(at.data(), g, k_context);
    EXPECT_GT(sum.n_violated, 10);
    return sum.sum;
  };
  value_at(z, gradient.data());
  double exact = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) exact += gradient[i] * direction[i];
  const auto error_at = [&](double step) {
    std::vector<double> ahead = z, behind = z;
    for (std::size_t i = 0; i < z.size(); ++i) {
      ahead[i] += step * direction[i];
      behind[i] -= step * direction[i];
    }
    return (value_at(ahead, nullptr) - value_at(behind, nullptr)) / (2.0 * step) - exact;
  };
  // Steps so small that no element changes between violated and not, or its lowest edge.
  const double step = GetParam() == 0 ? 1e-3 : 1e-4;
  const double coarse = error_at(step), fine = error_at(0.5 * step);
  EXPECT_LT(std::abs(fine), 1e-4 * std::abs(exact));
  if (std::abs(coarse) > 1e-9 * std::abs(exact)) {
    EXPECT_NEAR(coarse / fine, 4.0, 0.4);
  }
}

INSTANTIATE_TEST_SUITE_P(ObjectiveAndBothConstraints, PaperGradient, testing::Values(0, 1, 2));

class Nlopt : public testing::TestWithParam<NloptMethod> {};

TEST_P(Nlopt, ObjectiveFallsOnARealWing) {
  STERNA_NEEDS_SHARED_DATA();
  const surfmesh::StitchResult wall =
      surfmesh::stitch_surface({io::read_surface_file(test::shared_data() / "surfaces/clean/pygeo_bwb.stl", k_context)}, {}, k_context);
  const LayerBase base(wall.mesh, k_context);
  EnvelopeOptions options;
  options.layers = 35;
  options.first_height = 1e-6 * base.body_length;
  const Envelope start = build_envelope(base, options, k_context);
  const Column<VertexId, double> h_u = upper_heights(base, start);
  NloptSettings settings;
  settings.method = GetParam();
  settings.max_evaluations = 40;
  NloptReport report;
  const Envelope result = nlopt_optimise(base, start, h_u, options.first_height, settings, report, k_context);
  EXPECT_LT(report.best.total, report.run.history.front().total);
  EXPECT_LE(report.run.n_evaluations, settings.max_evaluations);
  EXPECT_FALSE(report.run.stopped.empty());
  EXPECT_FALSE(report.is_time_limit);
  EXPECT_TRUE(invalid_macros(base, result, k_context).empty());
  EXPECT_GE(smallest_scaled_jacobian(base, result, k_context), k_quality_share * smallest_scaled_jacobian(base, start, k_context) * (1.0 - 1e-12));

  NloptReport again;
  EXPECT_EQ(nlopt_optimise(base, start, h_u, options.first_height, settings, again, RunContext({.threads = 7})).height, result.height);

  settings.max_seconds = 1e-9;
  nlopt_optimise(base, start, h_u, options.first_height, settings, report, k_context);
  EXPECT_TRUE(report.is_time_limit);
  EXPECT_EQ(report.run.stopped, "time limit");
}

TEST_P(Nlopt, AnInfeasibleStartWalksToFeasibility) {
  const TriMesh sphere = hollow_sphere(6);
  const LayerBase base(sphere, k_context);
  EnvelopeOptions options = thick_layers();
  Envelope valid = initial_envelope(base, options, k_context);
  Envelope start = valid;
  for (const VertexId v : start.height.ids()) start.height[v] = v.value() % 3 == 0 ? 0.2 : 1.5;  // some beyond the centre, some not: inverted triangles
  NloptSettings settings;
  settings.method = GetParam();
  settings.max_evaluations = 5;
  NloptReport report;
  nlopt_optimise(base, start, start.height, options.first_height, settings, report, k_context);
  EXPECT_GT(report.n_shrunk, 0);
}

TEST_P(Nlopt, AStopEndsTheRun) {
  const TriMesh sphere = hollow_sphere(6);
  std::stop_source stop;
  const LayerBase base(sphere, k_context);
  const EnvelopeOptions options = thick_layers();
  const Envelope start = rough_envelope(base, options, 0.3, 0.4, k_context);
  const RunContext context({.threads = 1, .stop = stop.get_token()});
  NloptSettings settings;
  settings.method = GetParam();
  NloptReport report;
  stop.request_stop();
  try {
    nlopt_optimise(base, start, start.target, options.first_height, settings, report, context);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, Nlopt, testing::Values(NloptMethod::mma, NloptMethod::ccsaq));

}  // namespace
}  // namespace sterna::volmesh
