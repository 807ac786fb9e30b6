#include "io/surface/surface_tau.h"

#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"
#include "tests/support/test_shapes.h"

namespace sterna::test {
namespace {

TEST(SurfaceTau, SamplesGiveTheirBoundary) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"pt.taumesh", "pt.classic.grid"}) {
    const SurfaceSoup soup = read_surface(shared_data() / "formats" / name);
    EXPECT_EQ(triangles_by_patch(soup), (std::map<std::string, int>{{"wall", 1}, {"side", 6}, {"farfield", 3}}));
    EXPECT_NEAR(volume_of(soup), 2.0 / 3.0, 1e-15);
  }
  EXPECT_EQ(read_surface(shared_data() / "formats" / "mix4.taumesh").triangles.size(), 20u);
}

TEST(SurfaceTau, RoundTrip) {
  TriMesh cube = test::cube(3);
  cube.patches.push_back({"lid & <base>", PatchKind::slip});
  cube.triangle_patch[TriangleId(0)] = PatchId(1);
  const auto path = scratch() / "cube.grid";
  io::write_surface_file(cube, path, RunContext({.threads = 2}));
  const SurfaceSoup soup = read_surface(path);
  EXPECT_EQ(soup.points, cube.points.raw());
  EXPECT_EQ(triangles_by_patch(soup),
            (std::map<std::string, int>{{cube.patches[PatchId(0)].name, static_cast<int>(cube.n_triangles()) - 1}, {"lid & <base>", 1}}));
  EXPECT_NEAR(volume_of(soup), 1.0, 1e-14);
}

}  // namespace
}  // namespace sterna::test
