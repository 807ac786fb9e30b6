#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "geom/tets/recover.h"
#include "geom/tets/refine.h"
#include "tests/geom/tets/grids.h"
#include "tests/support/error_of.h"

namespace sterna::tets {
namespace {

using test::cube_of_tets;
using test::is_sound;
using test::TetSoup;

/// Returns a cube of 6^3 cells without a cross of cells: edges and corners of every kind, some of them reentrant.
TetSoup hollow_cube() {
  return cube_of_tets(6, [](const Vec3& p) {
    const Vec3 d = p - Vec3{0.5, 0.5, 0.5};
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) < 0.3 && (std::abs(d.x) < 0.2) + (std::abs(d.y) < 0.2) + (std::abs(d.z) < 0.2) >= 2;
  });
}

/// A size field that is smaller towards one corner, independent of the boundary points.
constexpr auto graded = [](const Vec3& p) { return 0.02 + 0.1 * distance(p, {0.1, 0.1, 0.1}); };

TetMesh refined(const TetSoup& soup, const SizeFunction& sizes, int threads, RefineReport& report) {
  const RunContext context({.threads = threads});
  TetMesh mesh = connect(soup.points, soup.tetrahedra, context);
  report = refine(mesh, static_cast<std::uint32_t>(soup.points.size()), sizes, context);
  return mesh;
}

double circumradius(const TetMesh& mesh, const Corners& v) {
  const Vec3 a = mesh.points[v[1]] - mesh.points[v[0]], b = mesh.points[v[2]] - mesh.points[v[0]], c = mesh.points[v[3]] - mesh.points[v[0]];
  return norm(norm2(a) * cross(b, c) + norm2(b) * cross(c, a) + norm2(c) * cross(a, b)) / (2.0 * dot(a, cross(b, c)));
}

TEST(TetRefine, KeepsTheBoundaryToTheBit) {
  const TetSoup soup = hollow_cube();
  RefineReport report;
  const TetMesh before = connect(soup.points, soup.tetrahedra, RunContext{});
  const TetMesh mesh = refined(soup, graded, 1, report);
  EXPECT_TRUE(is_sound(mesh));
  EXPECT_EQ(test::boundary_of(mesh), test::boundary_of(before));
  EXPECT_NEAR(test::volume_of(mesh), test::volume_of(before), 1e-12);
  EXPECT_TRUE(std::ranges::equal(soup.points, std::span(mesh.points).first(soup.points.size())));
  EXPECT_GT(report.n_inserted, 1000);
  std::vector<bool> is_used(mesh.points.size());
  for (const Corners& v : mesh.nodes)
    for (const std::uint32_t i : v) is_used[i] = true;
  EXPECT_EQ(std::ranges::count(is_used, false), 0);
}

TEST(TetRefine, MakesTheSizesThatAreWanted) {
  RefineReport report;
  const TetSoup soup = cube_of_tets(6);
  // Equal to the boundary edges at the boundary, and smaller inside.
  const auto sizes = [](const Vec3& p) { return 0.2 - 0.35 * std::min({p.x, p.y, p.z, 1.0 - p.x, 1.0 - p.y, 1.0 - p.z}); };
  const TetMesh mesh = refined(soup, sizes, 2, report);
  std::int64_t n_large = 0, n_inside = 0;
  for (const Corners& v : mesh.nodes) {
    if (std::ranges::min(v) < soup.points.size()) continue;
    ++n_inside;
    const Vec3 middle = 0.25 * (mesh.points[v[0]] + mesh.points[v[1]] + mesh.points[v[2]] + mesh.points[v[3]]);
    n_large += circumradius(mesh, v) > 0.85 * sizes(middle);
  }
  EXPECT_GT(n_inside, 1000);
  EXPECT_LT(n_large, n_inside / 100);
  double nearest = 1e9;
  for (std::size_t i = soup.points.size(); i < mesh.points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, distance(mesh.points[i], mesh.points[j]) / sizes(mesh.points[i]));
  EXPECT_GT(nearest, 0.6);  // 0.7 of the size at the point inserted last
}

TEST(TetRefine, EdgesHaveTheWantedLengthInTheMean) {
  RefineReport report;
  const auto constant = [](const Vec3&) { return 0.05; };
  const TetMesh mesh = refined(cube_of_tets(20), constant, 1, report);
  double sum = 0.0, n = 0.0;
  for (const Corners& v : mesh.nodes) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        sum += std::log(distance(mesh.points[v[i]], mesh.points[v[j]]) / 0.05);
        n += 1.0;
      }
    }
  }
  EXPECT_NEAR(std::exp(sum / n), 1.0, 0.1);  // as far as a boundary with such edges permits
}

TEST(TetRefine, IsTheSameForAnyThreads) {
  const TetSoup soup = cube_of_tets(10);
  const auto fine = [](const Vec3& p) { return 0.6 * graded(p); };
  std::vector<TetMesh> meshes(3);
  RefineReport report;
  for (std::size_t i = 0; i < 3; ++i) meshes[i] = refined(soup, fine, std::array{1, 2, 7}[i], report);
  EXPECT_GT(meshes[0].nodes.size(), 30000u);
  for (const TetMesh& mesh : meshes) {
    EXPECT_EQ(mesh.nodes, meshes[0].nodes);
    EXPECT_EQ(mesh.neighbours, meshes[0].neighbours);
    EXPECT_EQ(mesh.points, meshes[0].points);
  }
}

TEST(TetRefine, ScalesWithTheUnit) {
  TetSoup soup = hollow_cube();
  RefineReport report;
  const TetMesh metres = refined(soup, graded, 1, report);
  for (Vec3& p : soup.points) p *= 1024.0;
  const auto sizes = [](const Vec3& p) { return 1024.0 * graded(p / 1024.0); };
  EXPECT_EQ(refined(soup, sizes, 1, report).nodes, metres.nodes);
}

TEST(TetRefine, BoundarySliversDoNotPreventTermination) {
  TetSoup soup = cube_of_tets(8);
  for (Vec3& p : soup.points) p.z *= 1e-3;  // corner angles of 0.01 degrees
  RefineReport report;
  const TetMesh before = connect(soup.points, soup.tetrahedra, RunContext{});
  const TetMesh mesh = refined(soup, graded, 1, report);
  EXPECT_TRUE(is_sound(mesh));
  EXPECT_EQ(test::boundary_of(mesh), test::boundary_of(before));
}

TEST(TetRefine, StopsWhenTold) {
  std::stop_source stop;
  const RunContext context({.threads = 2, .stop = stop.get_token()});
  const TetSoup soup = cube_of_tets(6);
  TetMesh mesh = connect(soup.points, soup.tetrahedra, context);
  std::atomic<int> n_requested = 0;
  const auto sizes = [&](const Vec3& p) {
    if (++n_requested == 5000) stop.request_stop();
    return 0.2 * graded(p);
  };
  EXPECT_EQ(test::error_of([&] { refine(mesh, static_cast<std::uint32_t>(soup.points.size()), sizes, context); }).code(), ErrorCode::cancelled);
}

/// Adds the faces of a cube as n x n squares with all diagonals in one direction; the domain is outside or inside of the cube.
void add_structured_cube(std::uint32_t n, const Vec3& low, double side, bool is_room, std::vector<Vec3>& points, std::vector<Facet>& facets) {
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbers;
  const auto at = [&](std::size_t axis, std::uint32_t level, std::uint32_t i, std::uint32_t j) {
    std::array<std::uint32_t, 3> location{};
    location[axis] = level * n;
    location[(axis + 1) % 3] = i;
    location[(axis + 2) % 3] = j;
    const auto [it, is_new] = numbers.try_emplace(location, static_cast<std::uint32_t>(points.size()));
    if (is_new) points.push_back(low + side / n * Vec3{1.0 * location[0], 1.0 * location[1], 1.0 * location[2]});
    return it->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const std::uint32_t level : {0u, 1u})
      for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
          const std::uint32_t a = at(axis, level, i, j), b = at(axis, level, i + 1, j), c = at(axis, level, i + 1, j + 1), d = at(axis, level, i, j + 1);
          for (Facet f : {Facet{a, b, c}, Facet{a, c, d}}) {
            if ((level == 1) == is_room) std::swap(f[1], f[2]);
            facets.push_back(f);
          }
        }
}

/// Four points of each square are on one circle, and the flips that recover the required diagonals leave a mesh that is far from Delaunay. Cavities of a
/// thousand tetrahedra used to fall apart, and 250 tetrahedra that are flat over half a face used to remain.
TEST(TetRefine, StructuredPlaneFacesLeaveNothingFlatAndLong) {
  std::vector<Vec3> points;
  std::vector<Facet> facets;
  add_structured_cube(20, {0, 0, 0}, 1.0, false, points, facets);
  add_structured_cube(5, {-4, -4, -4}, 9.0, true, points, facets);
  const auto sizes = [](const Vec3& p) { return 0.05 + 0.3 * std::max(0.0, std::max({std::abs(p.x - 0.5), std::abs(p.y - 0.5), std::abs(p.z - 0.5)}) - 0.5); };
  std::optional<TetMesh> first;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    Recovery recovery = recover(points, facets, {}, context);
    ASSERT_EQ(recovery.failure.problem, "");
    const RefineReport report = refine(recovery.mesh, static_cast<std::uint32_t>(points.size()), sizes, context);
    EXPECT_EQ(report.n_far, 0);  // previously 245
    EXPECT_LT(report.n_left, static_cast<std::int64_t>(recovery.mesh.nodes.size() / 20));
    if (!first) {
      EXPECT_TRUE(is_sound(recovery.mesh));
      EXPECT_NEAR(test::volume_of(recovery.mesh), 728.0, 1e-8);
      first = recovery.mesh;
    } else {
      EXPECT_EQ(recovery.mesh.nodes, first->nodes) << threads;
      EXPECT_EQ(recovery.mesh.points, first->points) << threads;
    }
  }
}

}  // namespace
}  // namespace sterna::tets
