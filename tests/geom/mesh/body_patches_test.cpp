// Which patches a picture of bodies shows.
#include "geom/mesh/body_patches.h"

#include <gtest/gtest.h>

namespace sterna {
namespace {

Box box(const Point& low, const Point& high) {
  Box result;
  result.add(low);
  result.add(high);
  return result;
}

TEST(BodyPatches, are_walls_and_the_openings_in_them) {
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
  add("inlet", PatchKind::inflow, box({-5, -20, -20}, {-5, 20, 20}));  // of the tunnel: beyond the walls
  add("outlet", PatchKind::outflow, box({30, -10, -2}, {30, 10, 8}));  // within, but as large as they are
  add("farfield", PatchKind::farfield, box({-99, -99, -99}, {99, 99, 99}));
  EXPECT_EQ(patches_of_bodies(patches, boxes), (std::vector<std::uint8_t>{1, 1, 0, 0, 0}));
  Column<PatchId, Patch> no_walls;
  no_walls.push_back(patches[PatchId(2)]);
  EXPECT_EQ(patches_of_bodies(no_walls, std::vector<Box>{boxes[2]}), (std::vector<std::uint8_t>{1}));
}

}  // namespace
}  // namespace sterna
