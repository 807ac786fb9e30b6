// The paper's problem solved with NLopt: guarantees of a run, reasons for its end, and protection against a damaged envelope.
#include "volmesh/envelope/nlopt_optimise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stop_token>

#include "geom/base/error.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"
#include "tests/volmesh/optimise/rough_envelope.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

/// A wall with a valid envelope, and the input of every run on it.
struct Case {
  /// A cube with tilted growth lines and uneven heights.
  static Case cube() {
    Case c(test::cube(6));
    c.options.layers = 35;
    c.options.first_height = 1e-6;
    c.start = rough_envelope(c.base, c.options, 0.6, 0.5, k_context);
    c.finish();
    return c;
  }
  /// The inside of a sphere with uneven layers nearly to the centre: most triangles are inverted.
  static Case tangle() {
    Case c(hollow_sphere(6));
    c.options = thick_layers();
    c.start = initial_envelope(c.base, c.options, k_context);
    Noise noise;
    for (double& h : c.start.height) h = 0.9 + 0.1 * noise.next();
    c.start.target = c.start.cap = Column<VertexId, double>(c.mesh->n_vertices(), 1.0);
    c.finish();
    return c;
  }
  static Case wing() {
    Case c(surfmesh::stitch_surface({io::read_surface_file(test::shared_data() / "surfaces/clean/pygeo_bwb.stl", k_context)}, {}, k_context).mesh);
    c.options.layers = 35;
    c.options.first_height = 1e-6 * c.base.body_length;
    c.start = build_envelope(c.base, c.options, k_context);
    c.finish();
    return c;
  }
  Envelope run(const NloptSettings& settings, NloptReport& report, const RunContext& context = k_context) const {
    return nlopt_optimise(base, start, h_u, h_l, settings, report, context);
  }

  std::unique_ptr<const TriMesh> mesh;
  LayerBase base;
  EnvelopeOptions options;
  Envelope start;
  Column<VertexId, double> h_u;
  double h_l = 0.0;

 private:
  explicit Case(TriMesh m) : mesh(std::make_unique<const TriMesh>(std::move(m))), base(*mesh, k_context) {}
  void finish() {
    h_u = upper_heights(base, start);
    h_l = scale_of(base, options).least_height();
  }
};

double rise(const Case& c, const Envelope& envelope, VertexId v) { return envelope.height[v] * dot(envelope.direction[v], c.base.vertex_normal[v]); }

void expect_kept(const Case& c, const Envelope& result, const NloptReport& report) {
  EXPECT_TRUE(invalid_macros(c.base, result, k_context).empty());
  EXPECT_GE(smallest_scaled_jacobian(c.base, result, k_context), k_quality_share * smallest_scaled_jacobian(c.base, c.start, k_context) * (1 - 1e-12));
  for (const VertexId v : c.mesh->points.ids()) {
    const double before = rise(c, c.start, v);
    EXPECT_LE(rise(c, result, v), std::max(c.h_u[v], before) * (1 + 1e-12));
    EXPECT_GE(rise(c, result, v), std::min(c.h_l, before) * (1 - 1e-12));
  }
  const PaperProblem problem(c.base, c.start, c.h_u, c.h_l, NloptSettings{}.g1_min, k_context);
  EXPECT_LE(problem.objective(problem.unknowns(result), {}, k_context).total(), problem.objective(problem.unknowns(c.start), {}, k_context).total());
  double last = 1e300;
  for (const ObjectiveValue& value : report.run.history) {
    EXPECT_LT(value.total, last);
    last = value.total;
  }
  EXPECT_EQ(report.violations.size(), report.run.history.size());
  EXPECT_EQ(report.best.total, last);
}

NloptSettings settings_of(NloptMethod method, int max_evaluations = 300) {
  NloptSettings settings;
  settings.method = method;
  settings.max_evaluations = max_evaluations;
  return settings;
}

class Nlopt : public testing::TestWithParam<NloptMethod> {};

TEST_P(Nlopt, RealWingImprovesUntilTheEvaluationsAreSpent) {
  STERNA_NEEDS_SHARED_DATA();
  const Case c = Case::wing();
  NloptReport report;
  const Envelope result = c.run(settings_of(GetParam(), 30), report);
  EXPECT_EQ(report.run.stopped, "evaluations");
  EXPECT_EQ(report.run.n_evaluations, 30);
  EXPECT_EQ(report.n_feasibility_evaluations, 0);  // a valid envelope is feasible
  EXPECT_FALSE(report.is_time_limit);
  EXPECT_LT(report.best.total, 0.9 * report.run.history.front().total);  // 0.6 measured; 1 without slack or scaling
  EXPECT_LT(report.run.n_taken_back, report.run.n_moving / 5);
  expect_kept(c, result, report);
}

TEST_P(Nlopt, CubeConvergesToOptimumOfEachVertex) {
  // Without converging growth lines no constraint is active: full height, along the sum of the face normals.
  const Case c = Case::cube();
  NloptReport report;
  const Envelope result = c.run(settings_of(GetParam()), report);
  expect_kept(c, result, report);
  EXPECT_EQ(report.run.stopped, "converged");
  EXPECT_LT(report.run.n_evaluations, 200);
  EXPECT_NEAR(report.best.f2, 0.0, 1e-6);
  for (const VertexId v : c.mesh->points.ids()) {
    Vec3 sum;
    for (const HalfedgeId h : c.base.topology.outgoing(v)) sum += c.base.unit_normal[triangle_of(h)];
    EXPECT_LT(angle_between(result.direction[v], sum), 1e-3);
  }
}

TEST_P(Nlopt, WithoutSlackNloptStopsWhereItStarted) {
  // Checks the statement about 0 in the documentation of NloptSettings::slack; if a newer NLopt differs, the slack can be removed.
  STERNA_NEEDS_SHARED_DATA();
  const Case c = Case::wing();
  NloptSettings settings = settings_of(GetParam());
  settings.slack = 0.0;
  NloptReport report;
  const Envelope result = c.run(settings, report);
  expect_kept(c, result, report);
  EXPECT_LT(report.run.n_evaluations, 30);
  EXPECT_GT(report.best.total, 0.999 * report.run.history.front().total);
}

TEST_P(Nlopt, InfeasibleStartWalksToFeasibilityFirst) {
  const Case c = Case::tangle();
  const std::size_t n_invalid = invalid_macros(c.base, c.start, k_context).size();
  ASSERT_GT(n_invalid, c.mesh->n_triangles() / 10);
  NloptReport report;
  const Envelope result = c.run(settings_of(GetParam()), report);
  EXPECT_GT(report.n_feasibility_evaluations, 0);
  EXPECT_TRUE(report.is_feasible);
  ASSERT_FALSE(report.violations.empty());
  EXPECT_LT(report.violations.front().constraint.total(), 1e-5);
  EXPECT_LT(invalid_macros(c.base, result, k_context).size(), n_invalid / 2);  // feasible does not imply valid: (6) and (7) are necessary, not sufficient
}

TEST_P(Nlopt, StartThatCannotBeMadeFeasibleIsReturned) {
  Case c = Case::tangle();
  c.h_l = 0.9;  // at most a tenth of the wall's length is left, and a hundredth of its area
  NloptSettings settings = settings_of(GetParam(), 50);
  settings.g1_min = 0.5;
  NloptReport report;
  const Envelope result = c.run(settings, report);
  EXPECT_FALSE(report.is_feasible);
  EXPECT_EQ(report.run.stopped, "no feasible point found");
  EXPECT_EQ(result.height, c.start.height);
  EXPECT_EQ(result.direction, c.start.direction);
}

TEST_P(Nlopt, TimeLimitIsReportedWhenItStruck) {
  const Case c = Case::cube();
  NloptSettings settings = settings_of(GetParam());
  settings.tolerance = 0.0;
  settings.max_seconds = 1e-9;
  NloptReport report;
  const Envelope result = c.run(settings, report);
  EXPECT_TRUE(report.is_time_limit);
  EXPECT_EQ(report.run.stopped, "time limit");
  expect_kept(c, result, report);
}

TEST_P(Nlopt, StopRequestEndsRunningOptimisationAsError) {
  const Case c = Case::cube();
  std::stop_source source;
  const RunContext context({.threads = 2, .stop = source.get_token(), .progress = [&](const ProgressState&) { source.request_stop(); }});
  NloptSettings settings = settings_of(GetParam(), 1000000);
  settings.tolerance = 0.0;
  NloptReport report;
  try {
    c.run(settings, report, context);
    FAIL() << "was not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

TEST_P(Nlopt, SameBytesForAnyNumberOfThreads) {
  const Case c = Case::cube();
  std::vector<Envelope> results;
  for (const int threads : {1, 2, 7}) {
    NloptReport report;
    results.push_back(c.run(settings_of(GetParam(), 20), report, RunContext({.threads = threads})));
  }
  for (const Envelope& result : results) {
    EXPECT_EQ(result.height, results[0].height);
    EXPECT_EQ(result.direction, results[0].direction);
  }
}

TEST_P(Nlopt, NothingMovesWhenAllIsCollapsed) {
  Case c = Case::cube();
  for (double& h : c.start.height) h = 0.0;
  NloptReport report;
  const Envelope result = c.run(settings_of(GetParam()), report);
  EXPECT_EQ(report.run.stopped, "no vertex can move");
  EXPECT_EQ(result.height, c.start.height);
}

INSTANTIATE_TEST_SUITE_P(Solvers, Nlopt, testing::Values(NloptMethod::mma, NloptMethod::ccsaq));

/// Heights that cannot move: the height allowed by the user is just the height of the first layers.
TEST(GlobalOptimisation, EnvelopeWithoutFreeVerticesDoesNotChange) {
  const TriMesh wall = test::cube(3);
  for (const char* optimiser : {"mma", "ccsaq", "descent"}) {
    EnvelopeOptions options;
    options.layers = 5;
    options.first_height = 1e-2;
    options.max_thickness = 1.02e-2;  // below 1.05 of max(h0, h_min)
    options.optimiser = optimiser;
    const LayerBase base(wall, k_context);
    std::string log;
    const RunContext telling({.threads = 2, .log = [&](LogLevel, std::string_view text) { log += std::string(text) + "\n"; }});
    const Envelope envelope = build_envelope(base, options, telling);
    for (const double h : envelope.height) {
      EXPECT_GE(h, 0.0);
      EXPECT_LE(h, 1.02e-2);
    }
    EXPECT_TRUE(invalid_macros(base, envelope, k_context).empty()) << optimiser;
  }
}

}  // namespace
}  // namespace sterna::volmesh
