#include <gmock/gmock.h>

#include "io/trouble_vtu.h"
#include "io/volume_file.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/shapes.h"

namespace sterna::io {
namespace {

void write(const HybridMesh& mesh, const std::filesystem::path& path) { write_volume_file(mesh, path, RunContext({.threads = 2})); }

class VtuReaders : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Independent, VtuReaders, testing::Values("vtk", "meshio"), [](const auto& info) { return std::string(info.param); });

TEST_P(VtuReaders, Agree) {
  const auto path = test::scratch() / "mesh.vtu";
  // The last one has arrays of several compressed blocks.
  for (const HybridMesh& mesh : {test::mixed_mesh(), test::hexahedron_with_roof(), test::sphere_shell(28, {.n_layers = 5, .collapsed = {3, 50, 51}})}) {
    write(mesh, path);
    const auto report = test::read_independently(GetParam(), path);
    STERNA_NEEDS_READER(report);
    test::expect_same_mesh(*report, mesh);
    for (const PatchId patch : mesh.patches.ids())
      EXPECT_EQ(report->number("field.patch:" + std::string(to_string(mesh.patches[patch].kind)) + ":" + mesh.patches[patch].name), patch.value() + 1.0);
    for (int layer = 1; layer <= mesh.layers.n_layers; ++layer) {
      double n = 0.0;
      for (std::size_t c = 0; c < mesh.layers.n_columns(); ++c) n += mesh.layers.n_collapsed(c) < 3 ? 1.0 : 0.0;
      EXPECT_EQ(report->number("layer." + std::to_string(layer)), n);
    }
    if (report->has("vtk.volume")) {
      const double volume = test::volume_of(mesh);
      // VTK cuts cells with warped quads into tets of its own choice: equal in the sum to some percent of the warp only, and to rounding where quads are flat.
      EXPECT_NEAR(report->number("vtk.volume"), volume, 1e-3 * volume);
      EXPECT_GT(report->number("vtk.smallest"), 0.0);  // VTK's own opinion of the windings
    }
  }
}

TEST_P(VtuReaders, ReadTrouble) {
  const auto path = test::scratch() / "trouble.vtu";
  TroubleGeometry trouble;
  trouble.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  trouble.triangles = {{0, 1, 2}, {0, 1, 3}};
  trouble.edges = {{0, 1}};
  trouble.vertices = {3, 2, 1};
  write_trouble_vtu(trouble, path);
  const auto report = test::read_independently(GetParam(), path);
  STERNA_NEEDS_READER(report);
  EXPECT_EQ(report->number("points"), 4);
  EXPECT_EQ(report->number("cells.triangle"), 2);
  EXPECT_EQ(report->number("cells.line"), 1);
  EXPECT_EQ(report->number("cells.vertex"), 3);
}

TEST_P(VtuReaders, ReadSurfaces) {
  const auto path = test::scratch() / "surface.vtu";
  TriMesh cube = test::cube(3);
  cube.patches.push_back({"lid & <base>", PatchKind::slip});
  cube.triangle_patch[TriangleId(0)] = PatchId(1);
  write_surface_vtu(cube, path, RunContext({.threads = 2}));
  const auto report = test::read_independently(GetParam(), path);
  STERNA_NEEDS_READER(report);
  EXPECT_EQ(report->number("cells.triangle"), static_cast<double>(cube.n_triangles()));
  EXPECT_NEAR(report->number("enclosed"), 1.0, 1e-14);  // outward, rounding of some 100 terms
  EXPECT_EQ(report->number("faces.1"), static_cast<double>(cube.n_triangles()) - 1.0);
  EXPECT_EQ(report->number("faces.2"), 1);
}

TEST(Vtu, TroubleWithoutAnythingIsStillAFile) {
  const auto path = test::scratch() / "trouble.vtu";
  write_trouble_vtu({}, path);
  EXPECT_THAT(test::bytes_of(path), testing::HasSubstr("NumberOfPoints=\"0\" NumberOfCells=\"0\""));
}

}  // namespace
}  // namespace sterna::io
