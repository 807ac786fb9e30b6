// Crevices and gaps that become solid: gaps between boxes, wedges of few degrees, half models, and gaps that must stay open.
#include "volmesh/fill_crevices.h"

#include <gmock/gmock.h>

#include <cmath>

#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"
#include "tests/support/error_of.h"
#include "tests/support/halves.h"
#include "tests/support/rooms.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/support/voxels.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

/// Two unit cubes with a gap between x = 1 and x = 1 + gap.
TriMesh cubes_with_gap(double gap) {
  TriMesh wall = test::cube(4);
  TriMesh other = test::cube(4);
  other.patches[PatchId(0)].name = "other";
  for (Point& p : other.points) p.x += 1.0 + gap;
  append(wall, other);
  return wall;
}

void expect_sound(const TriMesh& wall, std::size_t n_boundary) {
  EXPECT_EQ(Topology(wall, k_context).n_boundary_halfedges(), n_boundary);
  EXPECT_TRUE(find_crossings(wall, k_context).pairs.empty());
}

TEST(FillCrevices, GapBetweenCubesBecomesSolid) {
  const TriMesh wall = cubes_with_gap(0.02);
  const CreviceResult made = fill_crevices(wall, {.width = 0.05}, k_context);
  expect_sound(made.wall, 0);
  // The gap is 1 x 1 x 0.02 m and its mouth is flat: the solid is a box of 2.02 m.
  EXPECT_NEAR(test::volume_of(made.wall), 2.02, 1e-9);
  ASSERT_EQ(made.report.crevices.size(), 1u);
  const FilledCrevice& crevice = made.report.crevices.front();
  EXPECT_NEAR(crevice.volume, 0.02, 1e-9);
  EXPECT_LE(crevice.width, 0.02 + 1e-12);
  EXPECT_LE(crevice.distance, 0.01 + 1e-9);  // middle of the mouth
  EXPECT_THAT(crevice.patches, testing::ElementsAre("cube", "other"));
  EXPECT_EQ(made.wall.patches, wall.patches);
  EXPECT_EQ(made.report.n_left, 0);
}

TEST(FillCrevices, WiderGapStaysUnchanged) {
  const TriMesh wall = cubes_with_gap(0.02);
  const CreviceResult made = fill_crevices(wall, {.width = 0.01}, k_context);
  EXPECT_TRUE(made.report.crevices.empty());
  EXPECT_EQ(made.wall.points, wall.points);
  EXPECT_EQ(made.wall.triangles, wall.triangles);
}

TEST(FillCrevices, SameTrianglesWithAnyNumberOfThreads) {
  const TriMesh wall = cubes_with_gap(0.02);
  const CreviceResult one = fill_crevices(wall, {.width = 0.05}, RunContext({.threads = 1}));
  const CreviceResult seven = fill_crevices(wall, {.width = 0.05}, RunContext({.threads = 7}));
  EXPECT_EQ(one.wall.points, seven.wall.points);
  EXPECT_EQ(one.wall.triangles, seven.wall.triangles);
}

TEST(FillCrevices, HalfModelKeepsItsBoundaryInThePlane) {
  const TriMesh half = test::cut_off(cubes_with_gap(0.02), 1, 0.25);
  const CreviceResult made = fill_crevices(half, {.width = 0.05}, k_context);
  ASSERT_EQ(made.report.crevices.size(), 1u);
  EXPECT_TRUE(find_crossings(made.wall, k_context).pairs.empty());
  const Topology topology(made.wall, k_context);
  EXPECT_GT(topology.n_boundary_halfedges(), 0u);
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (topology.is_boundary(h)) EXPECT_EQ(made.wall.points[topology.from(h)].y, 0.25);
  }
  EXPECT_NEAR(made.report.volume, 0.75 * 0.02, 1e-9);
}

TEST(FillCrevices, ApexOfSharpWedgeBecomesSolidUpToTheWidth) {
  const double angle = 5.0 * test::k_degree;
  const TriMesh room = test::wedge_room(angle, 10);
  const CreviceResult made = fill_crevices(room, {.width = 0.02}, k_context);
  expect_sound(made.wall, 0);
  ASSERT_FALSE(made.report.crevices.empty());
  const double before = -test::volume_of(room), after = -test::volume_of(made.wall);  // fluid is inside
  EXPECT_NEAR(before - after, made.report.volume, 1e-12);
  // Height of the wedge equals the width at r = 0.02 / angle = 0.23; tetrahedra reach from one ring of vertices (0.1) to the next.
  const double r = 0.02 / angle;
  EXPECT_GT(made.report.volume, 0.5 * angle * (r - 0.1) * (r - 0.1) * 0.5);
  EXPECT_LT(made.report.volume, 0.5 * angle * (r + 0.1) * (r + 0.1));
}

/// The angles of the room are 70, 55 and 55 degrees.
TEST(FillCrevices, WideWedgeIsNoCrevice) {
  const CreviceResult made = fill_crevices(test::wedge_room(70.0 * test::k_degree, 6), {.width = 0.5, .angle = 50.0 * test::k_degree}, k_context);
  EXPECT_TRUE(made.report.crevices.empty());
}

/// Two cups of voxels with their rims one voxel apart: the gap between the rims is the only way into the space inside.
TriMesh facing_cups() {
  const std::array<int, 3> n = {11, 11, 11};
  const auto is_fluid = [](int i, int j, int k) {
    const auto is_in = [](int a) { return a >= 2 && a <= 8; };
    const bool is_block = is_in(i) && is_in(j) && is_in(k);
    const bool is_inside = i >= 3 && i <= 7 && j >= 3 && j <= 7 && k >= 3 && k <= 7;
    return !is_block || is_inside || k == 5;
  };
  return test::voxel_boundary(n, 0.1, is_fluid, [](const Point& p, const Vec3&) {
    const bool is_outer = p.x < 0.05 || p.x > 1.05 || p.y < 0.05 || p.y > 1.05 || p.z < 0.05 || p.z > 1.05;
    return is_outer ? Patch{.name = "outer", .kind = PatchKind::farfield} : Patch{.name = "cups"};
  });
}

TEST(FillCrevices, GapThatConnectsFluidStaysOpen) {
  const TriMesh wall = facing_cups();
  const CreviceResult made = fill_crevices(wall, {.width = 0.12}, k_context);
  EXPECT_GT(made.report.n_left, 0);
  EXPECT_FALSE(made.report.left.empty());
  expect_sound(made.wall, 0);
}

TEST(FillCrevices, WedgeGapIsFilledUpToTheWidthOnly) {
  TriMesh wall = cubes_with_gap(0.01);  // widens from 0.01 m at y = 0 to 0.11 m at y = 1
  for (Point& p : wall.points)
    if (p.x == 1.01) p.x += 0.1 * p.y;
  const CreviceResult made = fill_crevices(wall, {.width = 0.06}, k_context);
  expect_sound(made.wall, 0);
  ASSERT_FALSE(made.report.crevices.empty());
  EXPECT_LE(made.report.distance, 0.03 * (1.0 + 1e-9));
  EXPECT_LE(made.report.crevices.front().box.max.y, 0.5 + 1e-9);  // the vertices at y = 0.5 have 0.06 m of gap
}

TEST(FillCrevices, DuctNarrowerThanTheWidthIsRefused) {
  TriMesh room = test::cube_room(4);
  for (Point& p : room.points) p.z *= 0.02;
  test::expect_error(ErrorCode::bad_argument, "of a region of the fluid is narrower than the width",
                     [&] { (void)fill_crevices(room, {.width = 0.05}, k_context); });
}

TEST(FillCrevices, OrderOfPartsDoesNotMatter) {
  TriMesh wall = test::cube(4), swapped = wall;
  TriMesh other = wall;
  for (Point& p : other.points) p.x += 1.02;
  swapped = other;
  append(swapped, wall);
  append(wall, other);
  EXPECT_NEAR(fill_crevices(wall, {.width = 0.05}, k_context).report.volume, fill_crevices(swapped, {.width = 0.05}, k_context).report.volume, 1e-9);
}

TEST(FillCrevices, WidthMustBePositive) {
  test::expect_error(ErrorCode::bad_argument, "is not positive", [] { (void)fill_crevices(test::cube(), {.width = 0.0}, k_context); });
  test::expect_error(ErrorCode::bad_argument, "no width is given", [] { (void)fill_crevices(test::cube(), {}, k_context); });
}

}  // namespace
}  // namespace sterna::volmesh
