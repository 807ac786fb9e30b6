#include "io/surface/surface_vtkhdf.h"

#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"
#include "tests/support/test_shapes.h"

namespace sterna::test {
namespace {

TEST(SurfaceVtkHdf, SamplesGiveTheirBoundary) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = read_surface(shared_data() / "formats" / "pt.vtkhdf");
  EXPECT_EQ(triangles_by_patch(soup), (std::map<std::string, int>{{"patch_1", 1}, {"patch_2", 6}, {"patch_3", 3}}));
  EXPECT_NEAR(volume_of(soup), 2.0 / 3.0, 1e-15);
  EXPECT_EQ(read_surface(shared_data() / "formats" / "mix4.v2.vtkhdf").triangles.size(), 20u);
}

TEST(SurfaceVtkHdf, RoundTrip) {
  TriMesh cube = test::cube(3);
  cube.patches.push_back({"lid & <base>/1", PatchKind::slip});
  cube.triangle_patch[TriangleId(0)] = PatchId(1);
  const auto path = scratch() / "cube.vtkhdf";
  io::write_surface_file(cube, path, RunContext({.threads = 2}));
  const SurfaceSoup soup = read_surface(path);
  EXPECT_EQ(soup.points, cube.points.raw());
  EXPECT_EQ(triangles_by_patch(soup),
            (std::map<std::string, int>{{cube.patches[PatchId(0)].name, static_cast<int>(cube.n_triangles()) - 1}, {"lid & <base>/1", 1}}));
  EXPECT_NEAR(volume_of(soup), 1.0, 1e-14);
}

}  // namespace
}  // namespace sterna::test
