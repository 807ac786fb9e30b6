#include <gmock/gmock.h>

#include <fstream>
#include <limits>

#include "io/container/hdf5_output.h"
#include "io/file/volume_file.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::io {
namespace {

using test::read;
using test::write;

TEST(VtkHdfRead, Samples) {
  STERNA_NEEDS_SHARED_DATA();
  for (const std::string version : {"", ".v2"}) {
    HybridMesh mesh = read(test::shared_data() / "formats" / ("pt" + version + ".vtkhdf"));
    EXPECT_EQ(mesh.prisms.size(), 1u);
    EXPECT_EQ(mesh.tetrahedra.size(), 1u);
    ASSERT_EQ(mesh.patches.size(), 3u);
    EXPECT_EQ(mesh.patches[PatchId(0)].name, "patch_1");
    EXPECT_NEAR(test::volume_of(mesh), 2.0 / 3.0, 1e-15);
    EXPECT_NEAR(test::enclosed_volume(mesh), 2.0 / 3.0, 1e-15);
    mesh = read(test::shared_data() / "formats" / ("mix4" + version + ".vtkhdf"));
    EXPECT_EQ(count_cells(mesh).total(), 4);
    EXPECT_NEAR(test::volume_of(mesh), 1.983333, 1e-6);  // value of docs/method/formats.md, "Sample meshes", to its digits
    EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-14);
  }
}

TEST(VtkHdf, RoundTripToTheBit) {
  const auto folder = test::scratch(), file = folder / "mesh.vtkhdf";
  test::expect_round_trips(file, read, [](const HybridMesh& mesh, const std::filesystem::path& path, int threads) { write(mesh, path, threads); });
  EXPECT_EQ(test::files_in(folder), (std::vector<std::string>{"mesh.vtkhdf"}));
}

TEST(VtkHdfWrite, VtkFindsTheSame) {
  const auto path = test::scratch() / "mesh.vtkhdf";
  for (const HybridMesh& mesh :
       {test::mesh_of_six_patches(), test::hexahedron_with_roof(), test::sphere_shell(28, {.n_layers = 5, .collapsed = {3, 50, 51}})}) {
    write(mesh, path);
    const auto report = test::read_independently("vtk", path);
    STERNA_NEEDS(report, "the Python module of the independent reader");
    test::expect_same_mesh(*report, mesh);
    for (const PatchId patch : mesh.patches.ids())
      EXPECT_EQ(report->number("field.patch:" + std::string(to_string(mesh.patches[patch].kind)) + ":" + mesh.patches[patch].name), patch.value() + 1.0);
    for (int layer = 1; layer <= mesh.layers.n_layers; ++layer) EXPECT_GT(report->number("layer." + std::to_string(layer)), 0.0);
    EXPECT_GT(report->number("vtk.smallest"), 0.0);  // VTK's own check of the windings
  }
}

TEST(VtkHdf, NamesComeBackWhole) {
  const auto file = test::scratch() / "mesh.vtkhdf";
  HybridMesh mesh = test::hexahedron_with_roof();
  mesh.patches[PatchId(0)].name = "left/wing: Flügel, and a name as long as one may want it to be";
  mesh.patches[PatchId(1)].name = std::string(300, 'x');
  std::vector<std::string> warnings;
  write_volume_file(mesh, file, RunContext({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                                              if (level == LogLevel::warning) warnings.emplace_back(line);
                                            }}));
  EXPECT_THAT(warnings, testing::ElementsAre(testing::HasSubstr("left_wing")));
  EXPECT_EQ(read(file).patches, mesh.patches);
}

/// Two partitions: one tetrahedron each, with ids and offsets of their own.
TEST(VtkHdfRead, PartitionsAreJoined) {
  const auto dataset = [](std::string name, OutputArray array) {
    return Hdf5OutputNode{.name = std::move(name), .is_dataset = true, .array = std::move(array)};
  };
  const auto numbers = [&](std::string name, const std::vector<std::int64_t>& values) {
    return dataset(std::move(name), output_numbers(NumberKind::i8, {values.size()}, values));
  };
  Hdf5OutputNode grid{.name = "VTKHDF"};
  grid.attributes = {text_attribute("Type", "UnstructuredGrid", 17)};
  grid.children = {
      numbers("NumberOfPoints", {4, 5}),
      numbers("NumberOfCells", {1, 2}),
      numbers("NumberOfConnectivityIds", {4, 6}),
      numbers("Connectivity", {0, 1, 2, 3, 1, 2, 3, 4, 0, 1}),
      numbers("Offsets", {0, 4, 0, 4, 6}),
      numbers("Types", {10, 10, 3}),
      dataset("Points", output_numbers<float>(NumberKind::f4, {9, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 9, 9, 2, 0, 0, 3, 0, 0, 2, 0, 1, 2, 1, 0}))};
  Hdf5OutputNode root;
  root.children = {grid};
  const auto path = test::scratch() / "two.hdf";
  write_hdf5(root, path, RunContext({.threads = 1}));
  std::vector<std::string> log;
  const HybridMesh mesh = read_volume_file(path, RunContext({.threads = 1, .log = [&](LogLevel, std::string_view line) { log.emplace_back(line); }}));
  ASSERT_EQ(mesh.tetrahedra.size(), 2u);
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1.0 / 3.0);
  EXPECT_THAT(log, testing::ElementsAre(testing::HasSubstr("left out: 1"), testing::HasSubstr("flipped: 1 of kind tetrahedron"),
                                        testing::HasSubstr("two.hdf: 1 of 2 cells in the file are inverted"), testing::HasSubstr("no boundary faces"),
                                        testing::HasSubstr("1 of 9 points belong to no cell")));
}

TEST(VtkHdfRead, MistakesAreTold) {
  const auto folder = test::scratch(), file = folder / "mesh.vtkhdf";
  HybridMesh mesh = test::hexahedron_with_roof();
  mesh.pyramids[0][4] = NodeId(99);
  write(mesh, file);
  test::expect_error(ErrorCode::file_malformed, "/VTKHDF/Connectivity: cell 0 has the node 99, there are 9", [&] { read(file); });
  std::ofstream(folder / "text.vtkhdf") << "NDIME= 3\n";
  test::expect_error(ErrorCode::file_malformed, "byte 0", [&] { read(folder / "text.vtkhdf"); });
  mesh = test::mixed_mesh();
  mesh.points[NodeId(4)].y = std::numeric_limits<double>::infinity();
  test::expect_error(ErrorCode::mesh_invalid, "node 4 are not finite", [&] { write(mesh, file); });
  write(test::mixed_mesh(), folder / "mesh.cgns");
  std::filesystem::rename(folder / "mesh.cgns", file);
  test::expect_error(ErrorCode::file_malformed, "/VTKHDF: there is no such group", [&] { read(file); });
}

TEST(VtkHdfRead, NeverCrashesOnDamagedFiles) {
  const auto file = test::scratch() / "mesh.vtkhdf";
  write(test::hexahedron_with_roof(), file);
  test::expect_survives_damage(file, "damaged.vtkhdf", test::k_few_attempts);
  if (test::has_shared_data())
    test::expect_survives_damage(test::shared_data() / "formats/pt.vtkhdf", "damaged.hdf", test::k_few_attempts);  // old-style groups, no checksums
}

}  // namespace
}  // namespace sterna::io
