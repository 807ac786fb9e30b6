// The paper's problem: values compared with hand-calculated ones, every gradient with central differences; free vertices; determinism.
#include "volmesh/envelope/paper_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geom/math/measures.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/initial.h"

namespace sterna::volmesh {
namespace {

using test::k_context;
using Part = PaperProblem::Part;

/// Deterministic numbers in [-0.5, 0.5).
class Noise {
 public:
  double next() {
    state_ = state_ * 1664525u + 1013904223u;
    return static_cast<double>(state_ >> 8) / 16777216.0 - 0.5;
  }

 private:
  std::uint32_t state_ = 11;
};

/// Returns an envelope with the given growth edges and the same target height for all.
Envelope envelope_of(const std::vector<Vec3>& growth, double target) {
  Envelope envelope;
  for (const Vec3& g : growth) {
    envelope.direction.push_back(normalized(g));
    envelope.height.push_back(norm(g));
  }
  envelope.target.assign(growth.size(), target);
  envelope.eq1 = envelope.cap = envelope.target;
  envelope.limit.assign(growth.size(), HeightLimit::none);
  return envelope;
}

/// One triangle in z = 0 with the right angle at the origin and legs of 1; its vertices are free, as if it had no open boundary.
TriMesh one_triangle() {
  TriMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{VertexId(0), VertexId(1), VertexId(2)}};
  mesh.triangle_patch = {PatchId(0)};
  mesh.patches = {{"wall", PatchKind::wall}};
  return mesh;
}

TEST(PaperProblem, OneWedgeByHand) {
  const TriMesh wall = one_triangle();
  const LayerBase base(wall, k_context);
  // Growth edges: upright with height 0.4; 45 degrees to the side, rising 0.5; below the plane of the wall by 0.1.
  const Envelope envelope = envelope_of({{0, 0, 0.4}, {0.5, 0, 0.5}, {0, -1.25, 0.3}}, 0.5);
  const PaperProblem problem(base, envelope, envelope.target, 1e-3, 0.3, k_context);
  ASSERT_EQ(problem.n_unknowns(), 9u);
  ASSERT_EQ(problem.n_elements(), 1u);
  std::vector<double> z = problem.unknowns(envelope);
  z[8] = -0.2;  // the third height to -0.1 m
  const PaperObjective f = problem.objective(z, {}, k_context);
  const double cosine = -0.1 / std::hypot(1.25, 0.1);
  EXPECT_NEAR(f.f1, ((1.0 - 1.0) + (1.0 - std::sqrt(0.5)) + (1.0 - cosine)) / 3.0, 1e-14);  // (8)
  EXPECT_NEAR(f.f2, ((1.0 - 0.8) + (1.0 - 1.0) + (1.0 + 0.2)) / 3.0, 1e-14);                // (9)
  // Envelope triangle: (0, 0, .4), (1.5, 0, .5), (0, -.25, -.1): z of twice its area vector is 1.5 * -0.25 - 0; divided by twice the wall area, which is 1: (6)
  // with g_1,min = 0.3
  const PaperConstraint g = problem.constraint(z, {}, k_context);
  EXPECT_NEAR(g.g1, 0.3 + 0.375, 1e-14);
  EXPECT_NEAR(g.g2, 0.1 / 0.5, 1e-14);  // (7), in units of h_u
  EXPECT_EQ(g.n_violated, 2);
  EXPECT_EQ(problem.constraint(problem.unknowns(envelope_of({{0, 0, 0.4}, {0.1, 0, 0.5}, {0, 0.1, 0.3}}, 0.5)), {}, k_context).n_violated, 0);
}

TEST(PaperProblem, BoundsAndWhoTakesPart) {
  const TriMesh cube = test::cube(4);
  const LayerBase base(cube, k_context);
  EnvelopeOptions options;
  options.first_height = 1e-3;
  options.layers = 10;
  options.max_growth = 1.4;  // the law of eq. (1); uniform growth has separate tests
  options.growth = "local";
  Envelope envelope = initial_envelope(base, options, k_context);
  Column<VertexId, double> h_u = envelope.target;
  const VertexId collapsed(0), low(20);
  envelope.height[collapsed] = 0.0;
  const double h_l = 2e-3;
  h_u[low] = 1.04 * h_l;
  envelope.height[low] = 1.03 * h_l;
  const PaperProblem problem(base, envelope, h_u, h_l, 0.01, k_context);
  EXPECT_FALSE(problem.takes_part(collapsed));
  EXPECT_FALSE(problem.takes_part(low));
  for (const VertexId v : base.topology.neighbours(collapsed)) EXPECT_FALSE(problem.takes_part(v));
  EXPECT_EQ(problem.n_vertices(), cube.n_vertices() - 2 - base.topology.neighbours(collapsed).size());
  EXPECT_EQ(problem.n_unknowns(), 3 * problem.n_vertices());
  const PaperBounds& bounds = problem.bounds();
  const std::vector<double> z = problem.unknowns(envelope);
  for (std::size_t i = 0; i < z.size(); ++i) {
    EXPECT_LE(bounds.lower[i], z[i] + 1e-14);
    EXPECT_GE(bounds.upper[i], z[i] - 1e-14);
  }
  std::size_t i = 0;
  for (const VertexId v : cube.points.ids()) {
    if (!problem.takes_part(v)) continue;
    EXPECT_NEAR(bounds.lower[i + 2] * h_u[v], h_l, 1e-15);
    EXPECT_EQ(bounds.upper[i + 2], 1.0);
    i += 3;
  }
  // Unknowns and envelope are two representations of the same state.
  Envelope copy = envelope;
  problem.store(z, copy, k_context);
  for (const VertexId v : cube.points.ids()) EXPECT_LT(distance(copy.point(cube, v), envelope.point(cube, v)), 1e-15);
}

TEST(PaperProblem, ConstraintsLeaveTwoOneOrNoTangentialUnknown) {
  const TriMesh cube = test::cube(2);
  Constraints constraints;
  constraints.vertex.resize(cube.n_vertices());
  const VertexId free(0), plane(1), line(2), fixed(3);
  const LayerBase plain(cube, k_context);
  const Vec3 n = plain.vertex_normal[plane];
  const Vec3 across = normalized(cross(n, Vec3{0.3, 0.5, 0.8}));
  constraints.vertex[plane] = {.freedom = Freedom::plane, .axis = across};
  constraints.vertex[line] = {.freedom = Freedom::line, .axis = plain.vertex_normal[line]};
  constraints.vertex[fixed] = {.freedom = Freedom::fixed, .axis = {}};
  const LayerBase base(cube, k_context, constraints);
  Envelope envelope = envelope_of(std::vector<Vec3>(cube.n_vertices(), Vec3{}), 0.1);
  for (const VertexId v : cube.points.ids()) {
    envelope.direction[v] = plain.vertex_normal[v];
    envelope.height[v] = 0.05;
  }
  const PaperProblem problem(base, envelope, envelope.target, 1e-3, 0.01, k_context);
  EXPECT_FALSE(problem.takes_part(fixed));
  EXPECT_EQ(problem.n_vertices(), cube.n_vertices() - 1);
  EXPECT_EQ(problem.n_unknowns(), 3 * problem.n_vertices() - 1 - 2);
  // For any unknowns, the points satisfy their constraints: vertex 0 has unknowns 0-2, vertex 1 has 3-4, vertex 2 has 5.
  std::vector<double> z(problem.n_unknowns(), 0.7);
  problem.store(z, envelope, k_context);
  EXPECT_NEAR(dot(envelope.direction[plane], across), 0.0, 1e-15);
  EXPECT_NEAR(envelope.height[plane], 0.1 * std::hypot(0.7, 0.7), 1e-15);
  EXPECT_NEAR(distance(envelope.direction[line], plain.vertex_normal[line]), 0.0, 1e-15);
  EXPECT_NEAR(envelope.height[free], 0.1 * 0.7 * std::sqrt(3.0), 1e-15);
}

TriMesh surface_named(const std::string& name) {
  if (name == "cube") return test::cube(5);
  if (name == "hollow_sphere") {  // lines converge
    TriMesh mesh = test::sphere(6);
    for (TriangleVertices& v : mesh.triangles) std::swap(v[1], v[2]);
    return mesh;
  }
  return surfmesh::stitch_surface({io::read_surface_file(test::shared_data() / "surfaces/clean" / name, k_context)}, {}, k_context).mesh;
}

EnvelopeOptions layers_for(const TriMesh& mesh) {
  EnvelopeOptions options;
  options.layers = 35;
  options.max_growth = 1.4;  // the law of eq. (1); uniform growth has separate tests
  options.growth = "local";
  options.first_height = 1e-6 * body_length(mesh);
  return options;
}

/// Equations (6) and (7) of one element, as an independent implementation from its points.
struct ElementConstraints {
  double g1 = 0.0, g2 = 0.0;
  std::array<double, 3> rise{};
};
ElementConstraints constraints_of(const LayerBase& base, const Column<VertexId, double>& h_u, const Envelope& envelope, TriangleId t, double g1_min) {
  const TriangleVertices& v = base.wall.triangles[t];
  const auto [a, b, c] = corners(base.wall, t);
  const Vec3 n_w = area_vector(a, b, c);
  const Vec3 n_e = area_vector(envelope.point(base.wall, v[0]), envelope.point(base.wall, v[1]), envelope.point(base.wall, v[2]));
  ElementConstraints result;
  result.g1 = g1_min - dot(n_w, n_e) / norm2(n_w);
  for (std::size_t k = 0; k < 3; ++k) result.rise[k] = dot(normalized(n_w), envelope.height[v[k]] * envelope.direction[v[k]]) / h_u[v[k]];
  result.g2 = -*std::min_element(result.rise.begin(), result.rise.end());
  return result;
}

/// An irregular point of a problem on a surface: tilted growth lines, uneven heights, many violated elements.
struct RoughCase {
  explicit RoughCase(const std::string& name)
      : mesh(surface_named(name)),
        base(mesh, k_context),
        envelope(initial_envelope(base, layers_for(mesh), k_context)),
        h_u(upper(base, envelope)),
        problem(base, envelope, h_u, 1e-6, k_g1_min, k_context),
        z(problem.unknowns(envelope)) {
    for (double& x : z) x += 2.4 * noise.next();
    problem.store(z, envelope, k_context);
  }
  static Column<VertexId, double> upper(const LayerBase& base, const Envelope& envelope) {
    Column<VertexId, double> h_u = envelope.target;
    for (const VertexId v : h_u.ids()) h_u[v] = std::max(h_u[v], envelope.height[v] * dot(envelope.direction[v], base.vertex_normal[v]));
    return h_u;
  }
  static constexpr double k_g1_min = 0.5;
  TriMesh mesh;
  LayerBase base;
  Envelope envelope;
  Column<VertexId, double> h_u;
  PaperProblem problem;
  std::vector<double> z;
  Noise noise;
};

class OnSurface : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam().find('.') != std::string::npos) STERNA_NEEDS_SHARED_DATA();
  }
};

TEST_P(OnSurface, SumsAgreeWithEquationsByElement) {
  const RoughCase rough(GetParam());
  double f1 = 0.0, f2 = 0.0, g1 = 0.0, g2 = 0.0;
  for (const TriangleId t : rough.mesh.triangles.ids()) {
    const ElementConstraints g = constraints_of(rough.base, rough.h_u, rough.envelope, t, RoughCase::k_g1_min);
    if (rough.envelope.is_collapsed(rough.mesh.triangles[t][0]) || rough.envelope.is_collapsed(rough.mesh.triangles[t][1]) ||
        rough.envelope.is_collapsed(rough.mesh.triangles[t][2]))
      continue;
    g1 += std::max(g.g1, 0.0);
    g2 += std::max(g.g2, 0.0);
    for (const VertexId v : rough.mesh.triangles[t])
      if (rough.problem.takes_part(v)) f1 += 1.0 - dot(rough.base.unit_normal[t], rough.envelope.direction[v]);
  }
  for (const VertexId v : rough.mesh.points.ids())
    if (rough.problem.takes_part(v)) f2 += 1.0 - rough.envelope.height[v] * dot(rough.envelope.direction[v], rough.base.vertex_normal[v]) / rough.h_u[v];
  const PaperObjective f = rough.problem.objective(rough.z, {}, k_context);
  const PaperConstraint g = rough.problem.constraint(rough.z, {}, k_context);
  EXPECT_NEAR(f.f1, f1 / (3.0 * static_cast<double>(rough.problem.n_elements())), 1e-12);
  EXPECT_NEAR(f.f2, f2 / static_cast<double>(rough.problem.n_vertices()), 1e-12);
  EXPECT_GT(g.g1, 0.0);
  EXPECT_GT(g.g2, 0.0);
  EXPECT_NEAR(g.g1, g1, 1e-10 * g1);
  EXPECT_NEAR(g.g2, g2, 1e-10 * g2);
}

TEST_P(OnSurface, EveryGradientMatchesCentralDifferencesAtSecondOrder) {
  RoughCase rough(GetParam());
  const PaperProblem& problem = rough.problem;
  ASSERT_GT(problem.n_vertices(), rough.mesh.n_vertices() / 2);
  // Along a curve z + s a + s^2 b + s^3 c, so that the linear f_2 and g_2 and the quadratic g_1 also have a third derivative.
  const std::size_t n = rough.z.size();
  std::vector<double> a(n), b(n), c(n);
  for (std::size_t i = 0; i < n; ++i) {
    a[i] = rough.noise.next();
    b[i] = rough.noise.next();
    c[i] = rough.noise.next();
  }
  // Sums over violated elements have kinks where an element becomes violated, or where another of its edges becomes the lowest: elements near a kink stay
  // fixed.
  constexpr double k_near = 0.05;
  Column<VertexId, std::uint8_t> stays(rough.mesh.n_vertices(), 0);
  for (const TriangleId t : rough.mesh.triangles.ids()) {
    const TriangleVertices& v = rough.mesh.triangles[t];
    double longest = 0.0, shortest = 1e300, reach = 0.0;  // for the rate of change of g_1: thick layers over needles
    for (std::size_t k = 0; k < 3; ++k) {
      const double edge = distance(rough.mesh.points[v[k]], rough.mesh.points[v[(k + 1) % 3]]);
      longest = std::max(longest, edge);
      shortest = std::min(shortest, edge);
      reach = std::max(reach, rough.h_u[v[k]]);
    }
    const ElementConstraints g = constraints_of(rough.base, rough.h_u, rough.envelope, t, RoughCase::k_g1_min);
    std::array<double, 3> rise = g.rise;
    std::sort(rise.begin(), rise.end());
    const double slenderness = norm2(area_vector(rough.mesh.points[v[0]], rough.mesh.points[v[1]], rough.mesh.points[v[2]]));
    const double rate = (longest + reach) * reach / std::sqrt(slenderness);
    if (std::abs(g.g1) < k_near * (1.0 + rate) || std::abs(g.g2) < k_near || rise[1] - rise[0] < k_near)
      for (const VertexId corner : v) stays[corner] = 1;
  }
  std::size_t i = 0;
  for (const VertexId v : rough.mesh.points.ids()) {
    if (!problem.takes_part(v)) continue;
    for (std::size_t k = 0; k < 3; ++k, ++i)
      if (stays[v]) a[i] = b[i] = c[i] = 0.0;
  }
  ASSERT_EQ(i, n);
  const auto at = [&](double s) {
    std::vector<double> z = rough.z;
    for (std::size_t j = 0; j < n; ++j) z[j] += s * (a[j] + s * (b[j] + s * c[j]));
    return z;
  };
  for (const Part part : {Part::f1, Part::f2, Part::g1, Part::g2}) {
    SCOPED_TRACE("part " + std::to_string(static_cast<int>(part)));
    std::vector<double> gradient(n);
    const double value = problem.part(part, rough.z, gradient, k_context);
    double exact = 0.0, size = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      exact += gradient[j] * a[j];
      size += std::abs(gradient[j] * a[j]);
    }
    ASSERT_GT(size, 0.0) << "no element whose " << value << " changes";
    const auto error_at = [&](double s) { return (problem.part(part, at(s), {}, k_context) - problem.part(part, at(-s), {}, k_context)) / (2.0 * s) - exact; };
    const double coarse = error_at(4e-3), fine = error_at(2e-3);
    EXPECT_LT(std::abs(fine), 1e-3 * size);
    EXPECT_NEAR(coarse / fine, 4.0, 0.2) << "errors " << coarse / size << " and " << fine / size << " of the slope";  // the next order is s^2 of this order
  }
}

TEST_P(OnSurface, SameBytesForAnyNumberOfThreads) {
  const RoughCase rough(GetParam());
  std::vector<double> first_f, first_g;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    std::vector<double> f(rough.z.size() + 2), g(rough.z.size() + 2);  // gradients, then values
    const PaperObjective objective = rough.problem.objective(rough.z, std::span(f).first(rough.z.size()), context);
    const PaperConstraint constraint = rough.problem.constraint(rough.z, std::span(g).first(rough.z.size()), context);
    f[rough.z.size()] = objective.f1;
    f[rough.z.size() + 1] = objective.f2;
    g[rough.z.size()] = constraint.g1;
    g[rough.z.size() + 1] = constraint.g2;
    if (threads == 1) {
      first_f = f;
      first_g = g;
    }
    EXPECT_EQ(f, first_f);
    EXPECT_EQ(g, first_g);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, OnSurface, testing::Values("cube", "hollow_sphere", "pygeo_bwb.stl"));

}  // namespace
}  // namespace sterna::volmesh
