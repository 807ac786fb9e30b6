// Selection of the patches that a picture of bodies shows.
#include "geom/mesh/body_patches.h"

#include <gtest/gtest.h>

#include "geom/mesh/cut_locations.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

Box box(const Point& low, const Point& high) {
  Box result;
  result.add(low);
  result.add(high);
  return result;
}

TEST(BodyPatches, AreWallsAndTheOpeningsInThem) {
  Column<PatchId, Patch> patches;
  std::vector<Box> boxes;
  const auto add = [&](const char* name, PatchKind kind, const Box& extent) {
    Patch patch;
    patch.name = name;
    patch.kind = kind;
    patches.push_back(patch);
    boxes.push_back(extent);
  };
  add("body", PatchKind::wall, box({0, -10, -2}, {30, 10, 8}));
  add("fan_face", PatchKind::outflow, box({10, 4, -1}, {10, 6, 1}));
  add("inlet", PatchKind::inflow, box({-5, -20, -20}, {-5, 20, 20}));  // tunnel inlet: outside the bounding box of the walls
  add("outlet", PatchKind::outflow, box({30, -10, -2}, {30, 10, 8}));  // inside the bounding box, but as large as the walls
  add("farfield", PatchKind::farfield, box({-99, -99, -99}, {99, 99, 99}));
  EXPECT_EQ(patches_of_bodies(patches, boxes), (std::vector<std::uint8_t>{1, 1, 0, 0, 0}));
  Column<PatchId, Patch> no_walls;
  no_walls.push_back(patches[PatchId(2)]);
  EXPECT_EQ(patches_of_bodies(no_walls, std::vector<Box>{boxes[2]}), (std::vector<std::uint8_t>{1}));
}

/// Returns a tunnel from -5 to 5 in every direction, flow along x, that contains a cube [at, at + 1]^3.
HybridMesh tunnel_with_cube(const Point& at) {
  HybridMesh mesh = test::box_of_patches({{"inlet", PatchKind::inflow},
                                          {"outlet", PatchKind::outflow},
                                          {"left", PatchKind::wall},
                                          {"right", PatchKind::wall},
                                          {"floor", PatchKind::wall},
                                          {"ceiling", PatchKind::wall}});
  for (Point& p : mesh.points) p = 10.0 * (p - Point{0.5, 0.5, 0.5});
  const HybridMesh cube = boundary_of(test::cube(2));
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  const PatchId body = mesh.patches.push_back({"body", PatchKind::wall});
  for (const Point& p : cube.points) mesh.points.push_back(p + at);
  for (const BoundaryTriangle& t : cube.boundary_triangles)
    mesh.boundary_triangles.push_back({{NodeId(first + t.nodes[0].value()), NodeId(first + t.nodes[1].value()), NodeId(first + t.nodes[2].value())}, body});
  return mesh;
}

TEST(BodyPatches, TunnelWallsDoNotBelongToBody) {
  for (const Point& at : {Point{0, 0, 0}, Point{0, 0, -5}}) {  // in the middle, then on the floor
    const HybridMesh mesh = tunnel_with_cube(at);
    EXPECT_EQ(outer_walls(mesh), (std::vector<std::uint8_t>{0, 0, 1, 1, 1, 1, 0}));
    EXPECT_EQ(patches_of_bodies(mesh), (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 1}));
  }
}

TEST(BodyPatches, WallsOfDuctWithoutBodyCountAsBody) {
  HybridMesh mesh = tunnel_with_cube({0, 0, 0});
  std::erase_if(mesh.boundary_triangles, [&](const BoundaryTriangle& t) { return mesh.patches[t.patch].name == "body"; });
  EXPECT_EQ(outer_walls(mesh), std::vector<std::uint8_t>(7, 0));
  EXPECT_EQ(patches_of_bodies(mesh)[PatchId(4).index()], 1);
}

TEST(BodyPatches, SurfaceIsNoWallAroundItself) {
  EXPECT_EQ(outer_walls(boundary_of(test::cube(2))), (std::vector<std::uint8_t>{0}));
  EXPECT_EQ(outer_walls(boundary_of(test::sphere(3))), (std::vector<std::uint8_t>{0}));
}

TEST(BodyPatches, ViewLocationsAreOnBodyNotOnTunnel) {
  const std::vector<CutLocation> locations = automatic_cuts(tunnel_with_cube({0.5, 0.25, 0}), test::k_context);
  ASSERT_FALSE(locations.empty());
  for (const CutLocation& location : locations) {
    EXPECT_LT(location.radius, 2.0) << location.name;
    EXPECT_LT(distance(location.focus, Point{1, 0.75, 0.5}), 1.0) << location.name;
  }
}

}  // namespace
}  // namespace sterna
