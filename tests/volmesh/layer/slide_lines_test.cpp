// Growth lines that slide after improvement, on a real surface whose folds and warped sides would FAIL gates.
#include <gtest/gtest.h>

#include <numbers>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

TriMesh fandisk() {
  return surfmesh::stitch_surface({io::read_surface_file(test::shared_data() / "surfaces/clean/pmp_fandisk.off", test::k_context)}, {}, test::k_context).mesh;
}

VolumeMeshResult meshed(const TriMesh& wall, double slide_share, int threads) {
  MeshCase options;
  const double length = body_length(wall);
  options.envelope.layers = 30;
  options.envelope.max_growth = 1.4;  // so that the heights of the layers match the tetrahedra
  options.envelope.growth = "local";
  options.envelope.first_height = 1e-6 * length;
  options.improve.slide_share = slide_share;
  return volume_mesh(wall, options, RunContext({.threads = threads}));
}

std::int64_t n_beyond(const VolumeMeshResult& result) {
  std::int64_t n = 0;
  for (const Measure measure : {Measure::interface_volume, Measure::interface_height, Measure::face_weight, Measure::face_tets})
    n += result.check.gate(measure).n_beyond_hard;
  return n;
}

TEST(SlideLines, MendWhatImprovementWithinTheBoundaryCannot) {
  STERNA_NEEDS_SHARED_DATA();
  const TriMesh wall = fandisk();
  const VolumeMeshResult as_made = meshed(wall, 0.0, 2), slid = meshed(wall, 0.2, 2);
  EXPECT_EQ(as_made.improvement.n_slid, 0);
  EXPECT_GT(slid.improvement.n_slid, 0);
  EXPECT_TRUE(slid.check.is_valid()) << to_text(slid.check);
  EXPECT_GT(n_beyond(as_made), 0);
  EXPECT_EQ(n_beyond(slid), 0) << to_text(slid.check);

  // The wall and the first cells are unchanged, and tops have moved at most as far as allowed: up by half as much as down, and also sideways.
  ASSERT_EQ(as_made.mesh.layers.n_lines(), slid.mesh.layers.n_lines());
  std::int64_t n_moved = 0;
  for (std::uint32_t line = 0; line < slid.mesh.layers.n_lines(); ++line) {
    const auto node = [&](const VolumeMeshResult& result, int j) { return result.mesh.points[result.mesh.layers.node(line, j)]; };
    EXPECT_EQ(node(as_made, 0), node(slid, 0));
    EXPECT_EQ(node(as_made, 1), node(slid, 1));
    const int n = slid.mesh.layers.n_steps(line);
    if (n == 0 || node(as_made, n) == node(slid, n)) continue;
    ++n_moved;
    const double height = distance(node(as_made, 0), node(as_made, n));
    EXPECT_LE(distance(node(as_made, n), node(slid, n)), (0.2 + 0.2 + 1e-9) * height);
  }
  EXPECT_EQ(n_moved, slid.improvement.n_slid);
  EXPECT_LE(n_moved, 200);  // some dozens of 6475: the remedy is local
}

TEST(SlideLines, SameBytesForAnyNumberOfThreads) {
  STERNA_NEEDS_SHARED_DATA();
  const TriMesh wall = fandisk();
  const VolumeMeshResult one = meshed(wall, 0.2, 1);
  for (const int threads : {2, 7}) {
    const VolumeMeshResult other = meshed(wall, 0.2, threads);
    EXPECT_EQ(one.mesh.points.raw(), other.mesh.points.raw());
    EXPECT_EQ(one.mesh.tetrahedra, other.mesh.tetrahedra);
  }
}

}  // namespace
}  // namespace sterna::volmesh
