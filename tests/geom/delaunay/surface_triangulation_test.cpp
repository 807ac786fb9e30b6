#include "geom/delaunay/surface_triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geom/base/error.h"
#include "geom/delaunay/check_triangulation.h"
#include "geom/delaunay/refinement_queue.h"
#include "geom/delaunay/renumber.h"
#include "geom/math/measures.h"
#include "tests/support/test_constants.h"

namespace sterna::delaunay {
namespace {

using test::k_context;
using test::k_pi;

/// A wave z = 0.2 sin(3 u) sin(3 v) over the plane, with badly scaled parameters: x = u / 1000, y = 1000 v.
SurfaceSample wave(Uv at) {
  const double x = at.u / 1000.0, y = 1000.0 * at.v;
  const Vec3 du = Vec3{1.0, 0.0, 0.6 * std::cos(3 * x) * std::sin(3 * y)} / 1000.0;
  const Vec3 dv = 1000.0 * Vec3{0.0, 1.0, 0.6 * std::sin(3 * x) * std::cos(3 * y)};
  return {{x, y, 0.2 * std::sin(3 * x) * std::sin(3 * y)}, {du, dv, normalized(cross(du, dv))}};
}
constexpr double k_speed_u = 1e-3, k_speed_v = 1e3;

SurfaceTriangulation square(int n) {
  SurfaceBorder border;
  border.loops.emplace_back();
  const auto add = [&](double x, double y) {
    border.loops[0].push_back(static_cast<std::uint32_t>(border.uv.size()));
    border.stands_for.push_back(VertexId(static_cast<std::uint64_t>(border.uv.size())));
    border.uv.push_back({1000.0 * x, y / 1000.0});
    border.samples.push_back(wave(border.uv.back()));
  };
  for (int i = 0; i < n; ++i) add(2.0 * i / n, 0);
  for (int i = 0; i < n; ++i) add(2.0, 2.0 * i / n);
  for (int i = 0; i < n; ++i) add(2.0 - 2.0 * i / n, 2.0);
  for (int i = 0; i < n; ++i) add(0.0, 2.0 - 2.0 * i / n);
  return triangulate_border(border, {scale_of_speed(k_speed_u), scale_of_speed(k_speed_v)}, k_context);
}

void expect_disc(const SurfaceTriangulation& surface, std::int64_t n_border_edges) {
  const TriangulationCheck check = check_triangulation(surface.mesh);
  EXPECT_TRUE(check.is_valid()) << check.text();
  EXPECT_EQ(check.euler_number(), 1);
  EXPECT_EQ(check.n_border_loops, 1);
  EXPECT_EQ(check.n_border_edges, n_border_edges);
}

struct RandomInsertions {
  SurfaceTriangulation surface = square(12);
  std::mt19937_64 random{3};
  Cavity cavity;
  int n_inserted = 0;

  TriangleId any_triangle() {
    for (;;) {
      const TriangleId t(random() % surface.mesh.cells.size());
      if (!surface.mesh.cells[t].is_dead) return t;
    }
  }
  VertexId any_inner_vertex() {
    for (;;) {
      const VertexId v(surface.n_border + random() % (surface.points.size() - surface.n_border));
      if (surface.mesh.outgoing[v].is_valid()) return v;
    }
  }
  InsertOutcome insert_any(double min_distance) {
    std::uniform_real_distribution<double> uniform(0.0, 2.0);
    const double x = uniform(random), y = uniform(random);
    const Uv at{1000.0 * x, y / 1000.0};
    const InsertOutcome outcome = insert_vertex(surface, at, wave(at), any_triangle(), min_distance, SphereCriterion{&surface.points, &surface.frames}, cavity);
    n_inserted += outcome == InsertOutcome::inserted ? 1 : 0;
    return outcome;
  }
};

TEST(SurfaceTriangulation, ScaleIsPowerOfTwoNearSpeed) {
  for (const double speed : {1e-9, 0.3, 1.0, 7e5}) {
    int exponent;
    EXPECT_EQ(std::frexp(scale_of_speed(speed), &exponent), 0.5);
    EXPECT_LE(scale_of_speed(speed), 2.0 * speed);
    EXPECT_GE(scale_of_speed(speed), speed);
  }
  EXPECT_EQ(scale_of_speed(0.0), 1.0);
}

TEST(SurfaceTriangulation, RandomInsertionsStayValid) {
  RandomInsertions mesh;
  expect_disc(mesh.surface, 48);
  for (int i = 0; i < 3000; ++i) mesh.insert_any(0.01);
  EXPECT_GT(mesh.n_inserted, 1000);
  expect_disc(mesh.surface, 48);
  flip_all(mesh.surface);
  expect_disc(mesh.surface, 48);
  // No edge remains that must be flipped.
  EXPECT_EQ(flip_all(mesh.surface), 0u);
}

TEST(SurfaceTriangulation, RefusedInsertionsChangeNothing) {
  RandomInsertions mesh;
  for (int i = 0; i < 200; ++i) mesh.insert_any(0.0);
  const auto before = extract_triangles(mesh.surface);
  const std::size_t n = mesh.surface.points.size();
  for (int i = 0; i < 200; ++i) EXPECT_NE(mesh.insert_any(100.0), InsertOutcome::inserted);
  const Uv beyond{3000.0, 0.001};
  const SphereCriterion criterion{&mesh.surface.points, &mesh.surface.frames};
  EXPECT_EQ(insert_vertex(mesh.surface, beyond, wave(beyond), mesh.any_triangle(), 0.0, criterion, mesh.cavity), InsertOutcome::beyond_border);
  EXPECT_EQ(extract_triangles(mesh.surface), before);
  EXPECT_EQ(mesh.surface.points.size(), n);
  EXPECT_EQ(mesh.surface.mesh.uv.size(), n);
  EXPECT_EQ(mesh.surface.frames.size(), n);
}

TEST(SurfaceTriangulation, RandomEditsStayValid) {
  RandomInsertions mesh;
  SurfaceTriangulation& s = mesh.surface;
  for (int i = 0; i < 1500; ++i) mesh.insert_any(0.005);
  std::uniform_real_distribution<double> shift(-0.05, 0.05);
  int n_collapsed = 0, n_moved = 0;
  for (int i = 0; i < 3000; ++i) {
    const VertexId v = mesh.any_inner_vertex();
    if (i % 2 == 0) {
      const Uv from = s.parameters(v), to{from.u + 1000.0 * shift(mesh.random), from.v + shift(mesh.random) / 1000.0};
      n_moved += move_vertex(s, v, to, wave(to)) ? 1 : 0;
    } else if (i % 3 == 0) {
      n_collapsed += collapse_edge(s, s.mesh.outgoing[v], 20.0) ? 1 : 0;
    }
    if (i % 100 == 0) expect_disc(s, 48);
  }
  expect_disc(s, 48);
  EXPECT_GT(n_moved, 20);
  EXPECT_GT(n_collapsed, 20);
}

TEST(SurfaceTriangulation, RenumberingKeepsTheTriangles) {
  RandomInsertions r;
  for (int i = 0; i < 2000; ++i) r.insert_any(0.02);
  for (int i = 0; i < 50; ++i) collapse_edge(r.surface, r.surface.mesh.outgoing[r.any_inner_vertex()], 20.0);
  const SurfaceTriangulation before = r.surface;
  const Column<VertexId, VertexId> old_id = renumber(r.surface);
  const SurfaceTriangulation& after = r.surface;
  expect_disc(after, 48);
  EXPECT_EQ(after.mesh.n_triangles(), before.mesh.n_triangles());
  EXPECT_EQ(after.mesh.cells.size(), after.mesh.n_triangles());
  EXPECT_LT(after.points.size(), before.points.size());
  for (const VertexId v : after.points.ids()) {
    EXPECT_EQ(after.points[v], before.points[old_id[v]]);
    EXPECT_EQ(after.mesh.uv[v].x, before.mesh.uv[old_id[v]].x);
    EXPECT_EQ(after.frames[v].normal, before.frames[old_id[v]].normal);
    EXPECT_EQ(old_id[after.stands_for[v]], before.stands_for[old_id[v]]);
    EXPECT_EQ(after.mesh.origin(after.mesh.outgoing[v]), v);
    EXPECT_TRUE(!after.is_border(v) || old_id[v] == v);
  }
  const auto sorted = [](std::vector<TriangleVertices> triangles) {
    for (TriangleVertices& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  std::vector<TriangleVertices> renamed = extract_triangles(after);
  for (TriangleVertices& t : renamed)
    for (VertexId& v : t) v = old_id[v];
  EXPECT_EQ(sorted(renamed), sorted(extract_triangles(before)));
}

TEST(SurfaceTriangulation, CoincidentBordersAreAnError) {
  SurfaceBorder border;
  const std::vector<Uv> locations{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 0}, {2, 0}, {2, 1}, {1, 1}};
  for (std::size_t i = 0; i < locations.size(); ++i) {
    border.uv.push_back(locations[i]);
    border.samples.push_back({{locations[i].u, locations[i].v, 5.0}, {}});
    border.stands_for.push_back(VertexId(static_cast<std::uint64_t>(i)));
  }
  border.loops = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  try {
    triangulate_border(border, {1, 1}, k_context);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::self_intersection);
    ASSERT_FALSE(error.info().locations.empty());
    EXPECT_EQ(error.info().locations[0].position.z, 5.0);
  }
}

TEST(SphereCriterion, IsTheCircleInAPlane) {
  // On z = 0 both criteria agree. The sphere is decided in rounded arithmetic, so only clear cases are compared.
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform;
  Triangulation mesh;
  Column<VertexId, Point> points;
  for (int i = 0; i < 4; ++i) {
    mesh.uv.push_back({});
    points.push_back({});
  }
  mesh.cells.push_back(Cell{.vertex = {VertexId(0u), VertexId(1u), VertexId(2u)}, .twin = {}});
  Column<VertexId, SurfaceFrame> frames(4, SurfaceFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  for (int k = 0; k < 10000; ++k) {
    for (const VertexId v : points.ids()) {
      mesh.uv[v] = {uniform(random), uniform(random)};
      points[v] = {mesh.uv[v].x, mesh.uv[v].y, 0.0};
    }
    const int turn = mesh.turn(VertexId(0u), VertexId(1u), VertexId(2u));
    const bool is_inside = SphereCriterion{&points, &frames}.conflicts(mesh, TriangleId(0), VertexId(3u));
    EXPECT_EQ(is_inside, turn * incircle(mesh.uv[VertexId(0u)], mesh.uv[VertexId(1u)], mesh.uv[VertexId(2u)], mesh.uv[VertexId(3u)]) > 0);
  }
}

TEST(SphereCriterion, LeavesOtherSideOfThinPartUnchanged) {
  Triangulation mesh;
  mesh.cells.push_back(Cell{{VertexId(0u), VertexId(1u), VertexId(2u)}, {}, {}, false, 0});
  const Column<VertexId, Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.4, 0.4, -0.01}};
  Column<VertexId, SurfaceFrame> frames(4, SurfaceFrame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  const auto conflicts = [&] { return SphereCriterion{&points, &frames}.conflicts(mesh, TriangleId(0), VertexId(3u)); };
  EXPECT_TRUE(conflicts());
  frames[VertexId(3u)].normal = {0, 0, -1};
  EXPECT_FALSE(conflicts());
  // A pole has no normal, so no conflict can be detected.
  frames[VertexId(3u)].normal = {};
  EXPECT_TRUE(conflicts());
}

TEST(WorstCotangent, OfKnownTriangles) {
  EXPECT_NEAR(worst_cotangent({0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}), 1.0 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(worst_cotangent({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 1.0, 1e-15);
  EXPECT_EQ(worst_cotangent({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(worst_cotangent({0, 0, 0}, {3, 0, 0}, {3, 3 * std::tan(k_pi / 18), 0}), 1.0 / std::tan(k_pi / 18), 1e-12);
}

TEST(RefineQueue, WorstFirstThenFirstCome) {
  RefineQueue queue;
  const double priorities[] = {1.0, 8.0, 1.0, 1e-12, 8.0, 1e30};
  for (std::uint32_t i = 0; i < 6; ++i) queue.push(priorities[i], {TriangleId(i), i});
  std::vector<std::uint32_t> order;
  for (RefineQueue::Entry entry; queue.pop(entry);) order.push_back(entry.stamp);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{5, 1, 4, 0, 2, 3}));
}

}  // namespace
}  // namespace sterna::delaunay
