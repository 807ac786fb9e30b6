// Insertion against brute force: exactly no point is inside the circumsphere of any tetrahedron.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geom/math/insphere.h"
#include "geom/tets/bulk_insert.h"
#include "tests/geom/tets/grids.h"
#include "tests/support/error_of.h"

namespace sterna::tets {
namespace {

using test::cube_of_tets;
using test::is_sound;
using test::TetSoup;

std::vector<Seed> seeds_at(const std::vector<Vec3>& locations) {
  std::vector<Seed> seeds;
  for (const Vec3& p : locations) seeds.push_back({.position = p, .start = 0, .room = {}});
  return seeds;
}

std::vector<Vec3> random_locations(int n, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> at(0.01, 0.99);
  std::vector<Vec3> locations;
  for (int i = 0; i < n; ++i) {
    const double x = at(generator), y = at(generator), z = at(generator);
    locations.push_back({x, y, z});
  }
  return locations;
}

TetMesh with_points(const std::vector<Vec3>& locations, int threads = 1) {
  const RunContext context({.threads = threads});
  const TetSoup cube = cube_of_tets(1);
  TetMesh mesh = connect(cube.points, cube.tetrahedra, context);
  BulkInserter inserter(mesh, context);
  for (const Insertion result : inserter.insert(seeds_at(locations), context)) EXPECT_EQ(result, Insertion::done);
  return mesh;
}

void expect_delaunay(const TetMesh& mesh, std::size_t n_points) {
  EXPECT_TRUE(is_sound(mesh));
  EXPECT_NEAR(test::volume_of(mesh), 1.0, 1e-12);
  std::vector<bool> is_used(mesh.points.size());
  for (std::uint32_t t = 0; t < mesh.nodes.size(); ++t) {
    if (!mesh.is_alive(t)) continue;
    const Corners& v = mesh.nodes[t];
    for (const std::uint32_t i : v) is_used[i] = true;
    for (const Vec3& p : mesh.points) ASSERT_LE(insphere(mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]], p), 0) << t;
  }
  EXPECT_EQ(std::ranges::count(is_used, true), static_cast<std::ptrdiff_t>(n_points));
}

TEST(TetInsert, RandomCloudsAreDelaunay) {
  for (const unsigned seed : {1u, 2u, 3u}) expect_delaunay(with_points(random_locations(400, seed)), 408);
}

TEST(TetInsert, PointsOnOneSphereHaveOneAnswer) {
  // 7^3 points of a grid: eight on one sphere around each cell, many in one plane.
  std::vector<Vec3> locations;
  for (int i = 1; i < 8; ++i)
    for (int j = 1; j < 8; ++j)
      for (int k = 1; k < 8; ++k) locations.push_back({i / 8.0, j / 8.0, k / 8.0});
  const TetMesh mesh = with_points(locations);
  expect_delaunay(mesh, 351);
  // For the grid's own tetrahedra, whose spheres hold no corner of the cube, ties are decided by the node numbers.
  for (std::uint32_t t = 0; t < mesh.nodes.size(); ++t) {
    if (!mesh.is_alive(t) || std::ranges::min(mesh.nodes[t]) < 8) continue;
    for (std::uint32_t p = 8; p < mesh.points.size(); ++p) {
      if (std::ranges::find(mesh.nodes[t], p) != mesh.nodes[t].end()) continue;
      ASSERT_LT(perturbed_sphere_side(mesh, mesh.nodes[t], p), 0);
    }
  }
}

TEST(TetInsert, ManyPointsGiveSameMeshForAnyThreads) {
  // Enough points for many blocks; from the second call on, the search starts near each point's final position.
  const RunContext one({.threads = 1});
  const TetSoup cube = cube_of_tets(12);
  std::vector<TetMesh> meshes;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    TetMesh& mesh = meshes.emplace_back(connect(cube.points, cube.tetrahedra, context));
    BulkInserter inserter(mesh, context);
    std::vector<Seed> seeds = seeds_at(random_locations(30000, 5));
    for (Seed& seed : seeds) {
      const auto cell = [&](double x) { return static_cast<std::uint32_t>(12.0 * x); };
      seed.start = 6 * (144 * cell(seed.position.x) + 12 * cell(seed.position.y) + cell(seed.position.z));
    }
    for (const Insertion result : inserter.insert(seeds, context)) EXPECT_EQ(result, Insertion::done);
    EXPECT_LT(inserter.n_serial(), 25000);  // blocks do some of the work, although in such a coarse mesh most of the work is at block borders
  }
  EXPECT_TRUE(is_sound(meshes[0]));
  EXPECT_NEAR(test::volume_of(meshes[0]), 1.0, 1e-10);
  for (const TetMesh& mesh : meshes) {
    EXPECT_EQ(mesh.nodes, meshes[0].nodes);
    EXPECT_EQ(mesh.neighbours, meshes[0].neighbours);
    EXPECT_EQ(mesh.points, meshes[0].points);
  }
}

TEST(TetInsert, ASphereIsJudgedExactly) {
  // The corners of a cube far from the origin are on one sphere; a shift by one bit decides.
  const double far = 1048576.0;
  const auto corner = [&](double x, double y, double z) { return Vec3{far + x, far + y, far + z}; };
  const Vec3 a = corner(0, 0, 0), b = corner(1, 0, 0), c = corner(0, 1, 0), d = corner(0, 0, 1);
  ASSERT_EQ(orient3d(a, b, c, d), 1);
  EXPECT_EQ(insphere(a, b, c, d, corner(1, 1, 1)), 0);
  EXPECT_EQ(insphere(a, b, c, d, {far + 1, far + 1, std::nextafter(far + 1, far)}), 1);
  EXPECT_EQ(insphere(a, b, c, d, {far + 1, far + 1, std::nextafter(far + 1, 2 * far)}), -1);
  EXPECT_EQ(insphere(b, a, c, d, {far + 1, far + 1, std::nextafter(far + 1, far)}), -1);
}

TEST(TetInsert, TellsWhyNot) {
  const RunContext context;
  const TetSoup cube = cube_of_tets(3, [](const Vec3& p) { return distance(p, {0.5, 0.5, 0.5}) < 0.1; });  // a cell in the middle is missing
  TetMesh mesh = connect(cube.points, cube.tetrahedra, context);
  BulkInserter inserter(mesh, context);
  const std::vector<Corners> before = mesh.nodes;
  const std::vector<Seed> seeds = {{.position = {2.0, 0.5, 0.5}, .start = 0, .room = {}},
                                   {.position = {0.5, 0.5, 0.5}, .start = 0, .room = {}},
                                   {.position = {0.02, 0.02, 0.01}, .start = 0, .room = {.to_points = 0.1}},
                                   {.position = {0.2, 0.15, 0.01}, .start = 0, .room = {.to_points = 0.0, .to_boundary = 0.1}},
                                   {.position = {1.0 / 3, 1.0 / 3, 1.0 / 3}, .start = 0, .room = {}}};
  const std::vector<Insertion> results = inserter.insert(seeds, context);
  EXPECT_EQ(results[0], Insertion::outside);
  EXPECT_EQ(results[1], Insertion::outside);
  EXPECT_EQ(results[2], Insertion::too_near);
  EXPECT_EQ(results[3], Insertion::encroaches);
  EXPECT_EQ(results[4], Insertion::no_cavity);  // there already is a point at this location
  EXPECT_TRUE(std::ranges::equal(before, std::span(mesh.nodes).first(before.size())));
}

TEST(TetInsert, ConnectNamesWhatIsWrong) {
  const RunContext context;
  TetSoup cube = cube_of_tets(2);
  TetSoup twice = cube;
  twice.tetrahedra.push_back(twice.tetrahedra.front());
  test::expect_error(ErrorCode::tetra_result_invalid, "more than two tetrahedra", [&] { connect(twice.points, twice.tetrahedra, context); });
  std::swap(cube.tetrahedra[3][0], cube.tetrahedra[3][1]);
  test::expect_error(ErrorCode::tetra_result_invalid, "1 tetrahedra without positive volume", [&] { connect(cube.points, cube.tetrahedra, context); });
}

}  // namespace
}  // namespace sterna::tets
