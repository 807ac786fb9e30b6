#include "io/surface/surface_cgns.h"

#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"
#include "tests/support/process.h"
#include "tests/support/test_shapes.h"

namespace sterna::test {
namespace {

TriMesh cube_of_two_patches() {
  TriMesh cube = test::cube(3);
  cube.patches.push_back({"lid & <base>", PatchKind::slip});
  cube.triangle_patch[TriangleId(0)] = PatchId(1);
  return cube;
}

TEST(SurfaceCgns, VolumeSamplesGiveTheirBoundary) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* name : {"pt.hdf5.cgns", "pt.adf.cgns", "pt.adf.v46.cgns", "pt.mixed.v46.cgns"}) {
    SCOPED_TRACE(name);
    const SurfaceSoup soup = read_surface(shared_data() / "formats" / name);
    EXPECT_EQ(triangles_by_patch(soup), (std::map<std::string, int>{{"wall", 1}, {"side", 6}, {"farfield", 3}}));
    EXPECT_NEAR(volume_of(soup), 2.0 / 3.0, 1e-15);
    EXPECT_EQ(soup.points.size(), 7u);
    EXPECT_TRUE(soup.has_names);
  }
}

TEST(SurfaceCgns, WallsOfStructuredBlocks) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = read_surface(shared_data() / "surfaces/nasty/mdo_717_cgns_717_wl_L2.cgns");
  EXPECT_EQ(triangles_by_patch(soup), (std::map<std::string, int>{{"wall", 1512}}));  // tests/data/shared/README.md
}

TEST(SurfaceCgns, RoundTripInBothContainers) {
  const TriMesh cube = cube_of_two_patches();
  for (const char* name : {"cube.cgns", "cube.adf.cgns"}) {
    SCOPED_TRACE(name);
    const auto path = scratch() / name;
    io::write_surface_file(cube, path, RunContext({.threads = 2}));
    const SurfaceSoup soup = read_surface(path);
    EXPECT_EQ(soup.points, cube.points.raw());
    EXPECT_EQ(triangles_by_patch(soup),
              (std::map<std::string, int>{{cube.patches[PatchId(0)].name, static_cast<int>(cube.n_triangles()) - 1}, {"lid & <base>", 1}}));
    EXPECT_NEAR(volume_of(soup), 1.0, 1e-14);
    const std::string program = "/usr/bin/cgnscheck";
    STERNA_NEEDS(std::filesystem::exists(program), "cgnscheck of the package cgns-convert");
    const ProcessResult check = run_process(program, {path.string()}, path.parent_path());
    EXPECT_EQ(check.output.find("ERROR"), std::string::npos) << check.output;
    EXPECT_EQ(check.output.find("WARNING"), std::string::npos) << check.output;
  }
}

TEST(SurfaceCgns, PackedByGzip) {
  const auto folder = scratch();
  const auto path = folder / "cube.cgns";
  io::write_surface_file(test::cube(1), path, RunContext({.threads = 1}));
  write_bytes(folder / "packed.cgns.gz", packed(bytes_of(path)));
  EXPECT_EQ(read_surface(folder / "packed.cgns.gz").points, test::cube(1).points.raw());
}

}  // namespace
}  // namespace sterna::test
