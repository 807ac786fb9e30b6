#include <gmock/gmock.h>

#include <fstream>
#include <limits>

#include "io/file/volume_file.h"
#include "io/volume/volume_tau.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::io {
namespace {

using test::read;
using test::write;

TEST(Tau, SamplesByteForByte) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats", folder = test::scratch();
  for (const std::string name : {"pt.taumesh", "mix4.taumesh", "pt.classic.grid"}) {
    SCOPED_TRACE(name);
    const HybridMesh mesh = read(samples / name);
    const bool is_pt = name.starts_with("pt");
    EXPECT_EQ(mesh.patches.raw(),
              (std::vector<Patch>{{"wall", PatchKind::wall}, {is_pt ? "side" : "symmetry", PatchKind::symmetry}, {"farfield", PatchKind::farfield}}));
    const double volume = is_pt ? 2.0 / 3.0 : 1.0 + 1.0 / 3.0 + 0.65;
    EXPECT_NEAR(test::volume_of(mesh), volume, 1e-14);
    EXPECT_NEAR(test::enclosed_volume(mesh), volume, 1e-14);
    write(mesh, folder / name);
    if (name != "pt.classic.grid") {  // this file is CDF-1
      EXPECT_EQ(test::bytes_of(folder / name), test::bytes_of(samples / name));
    }
    std::string mapping = test::bytes_of((folder / name).replace_extension(".bmap"));
    const std::string option = " Write surface data (0/1): 1\n";  // missing in the samples
    mapping.erase(mapping.find(option), option.size());
    EXPECT_EQ(mapping, test::bytes_of((samples / name).replace_extension(".bmap")));
  }
}

TEST(Tau, RoundTripToTheBit) {
  const auto folder = test::scratch(), file = folder / "mesh.taumesh";
  test::expect_round_trips(file, read, [](const HybridMesh& mesh, const std::filesystem::path& path, int threads) { write(mesh, path, threads); });
  EXPECT_EQ(test::files_in(folder), (std::vector<std::string>{"mesh.bmap", "mesh.taumesh"}));
}

TEST(Tau, NcdumpReadsIt) {
  const auto file = test::scratch() / "mesh.grid";
  const HybridMesh mesh = test::mesh_of_six_patches();
  write(mesh, file);
  const auto kind = test::output_of_tool("ncdump", {"-k", file.string()});
  STERNA_NEEDS(kind, "ncdump of the package netcdf-bin");
  EXPECT_EQ(*kind, "64-bit offset\n");
  const std::string head = *test::output_of_tool("ncdump", {"-v", "marker,boundarymarker_of_surfaces", file.string()});
  const CellCounts counts = count_cells(mesh);
  for (const std::string& part : {"no_of_prisms = " + std::to_string(counts.prisms) + " ;", "no_of_tetraeders = " + std::to_string(counts.tetrahedra) + " ;",
                                  "no_of_elements = " + std::to_string(counts.total()) + " ;", "no_of_points = " + std::to_string(mesh.points.size()) + " ;",
                                  std::string("int points_of_pyramids(no_of_pyramids, points_per_pyramid) ;"), std::string("double points_zc(no_of_points) ;"),
                                  std::string(":marker_4 = \"symmetry\" ;"), std::string("marker = 1, 2, 3, 4, 5, 6 ;")})
    EXPECT_THAT(head, testing::HasSubstr(part));
}

TEST(Tau, RoundTripInCdf5) {
  const auto file = test::scratch() / "mesh.grid";
  const HybridMesh mesh = test::mesh_of_six_patches();
  write_volume_tau(mesh, file, TauNetcdf::cdf5, RunContext({.threads = 2}));
  test::expect_equal_meshes(read(file), mesh);
  const auto kind = test::output_of_tool("ncdump", {"-k", file.string()});
  STERNA_NEEDS(kind, "ncdump of the package netcdf-bin");
  EXPECT_EQ(*kind, "cdf5\n");
  EXPECT_THAT(*test::output_of_tool("ncdump", {"-v", "marker", file.string()}), testing::HasSubstr("marker = 1, 2, 3, 4, 5, 6 ;"));
}

/// The same grid written with Debian's library: other versions, groups in heaps, compressed chunks.
TEST(TauRead, OtherKindsOfNetcdf) {
  const auto folder = test::scratch(), file = folder / "mesh.grid";
  const HybridMesh mesh = test::mesh_of_six_patches();
  write(mesh, file);
  const std::vector<std::vector<std::string>> kinds = {
      {"-k", "classic"}, {"-k", "cdf5"}, {"-k", "netCDF-4"}, {"-k", "netCDF-4", "-d", "5", "-s"}, {"-k", "netCDF-4 classic model", "-d", "1"}};
  for (std::vector<std::string> arguments : kinds) {
    SCOPED_TRACE(arguments[1] + " " + std::to_string(arguments.size()));
    const auto copy = folder / "copy.grid";
    arguments.insert(arguments.end(), {file.string(), copy.string()});
    STERNA_NEEDS(test::output_of_tool("nccopy", arguments), "nccopy of the package netcdf-bin");
    std::filesystem::copy_file(folder / "mesh.bmap", folder / "copy.bmap", std::filesystem::copy_options::overwrite_existing);
    test::expect_equal_meshes(read(copy), mesh);
    if (arguments.size() == 7) test::expect_survives_damage(copy, "damaged.grid", test::k_few_attempts);
  }
}

TEST(TauRead, HeapsOfManyNames) {
  // 700 attributes and variables besides the mesh fill several rows of a heap and a B-tree of two levels.
  std::string text =
      "netcdf many {\ndimensions:\n n = 1 ;\n no_of_points = 1 ;\nvariables:\n double points_xc(no_of_points), points_yc(no_of_points), "
      "points_zc(no_of_points) ;\n";
  for (int i = 0; i < 700; ++i) text += " int a_variable_with_a_longer_name_" + std::to_string(i) + "(n) ;\n";
  for (int i = 0; i < 700; ++i) text += " :an_attribute_with_a_longer_name_" + std::to_string(i) + " = \"some text for number " + std::to_string(i) + "\" ;\n";
  text += "data:\n points_xc = 1 ;\n points_yc = 2 ;\n points_zc = 3 ;\n}\n";
  const auto folder = test::scratch();
  std::ofstream(folder / "many.cdl") << text;
  STERNA_NEEDS(test::output_of_tool("ncgen", {"-k", "nc4", "-o", (folder / "many.grid").string(), (folder / "many.cdl").string()}),
               "ncgen of the package netcdf-bin");
  EXPECT_EQ(read(folder / "many.grid").points.raw(), (std::vector<Point>{{1, 2, 3}}));
}

TEST(TauRead, NamesComeFromAttributesThenTheMapping) {
  const auto file = test::scratch() / "mesh.grid";
  write(test::hexahedron_with_roof(), file);
  std::string bytes = test::bytes_of(file);
  for (const std::string name : {"marker_1", "marker_2"}) bytes.replace(bytes.find(name), name.size(), "no_name" + name.substr(7));
  std::ofstream(file, std::ios::binary) << bytes;
  EXPECT_EQ(read(file).patches, test::hexahedron_with_roof().patches);
  std::ofstream((file.parent_path() / "mesh.bmap")) << "# all walls\n Markers: 1, 2\n Type: euler wall\n Name: body # comment\n block end\n";
  EXPECT_EQ(read(file).patches.raw(), (std::vector<Patch>{{"body", PatchKind::slip}, {"body", PatchKind::slip}}));
  std::ofstream((file.parent_path() / "mesh.bmap")) << "Markers: one\n";
  test::expect_error(ErrorCode::file_malformed, "line 1: found the marker \"one\"", [&] { read(file); });
  std::filesystem::remove(file.parent_path() / "mesh.bmap");
  EXPECT_EQ(read(file).patches.raw(), (std::vector<Patch>{{"patch_1", PatchKind::wall}, {"patch_2", PatchKind::wall}}));
}

TEST(TauWrite, RefusesWhatItCannotHold) {
  HybridMesh mesh = test::mixed_mesh();
  const auto folder = test::scratch();
  mesh.points[NodeId(4)].y = std::numeric_limits<double>::infinity();
  test::expect_error(ErrorCode::mesh_invalid, "node 4 are not finite", [&] { write(mesh, folder / "mesh.taumesh"); });
  test::expect_error(ErrorCode::write_failed, "no_such_folder", [&] { write(test::hexahedron_with_roof(), folder / "no_such_folder" / "mesh.grid"); });
  EXPECT_TRUE(test::files_in(folder).empty());
}

TEST(TauRead, MistakesAreTold) {
  const auto folder = test::scratch();
  HybridMesh mesh = test::hexahedron_with_roof();
  mesh.pyramids[0][4] = NodeId(99);
  write(mesh, folder / "mesh.taumesh");
  test::expect_error(ErrorCode::file_malformed, "variable \"points_of_pyramids\": element 0 has point 99, expected 0 to 8",
                     [&] { read(folder / "mesh.taumesh"); });
  test::expect_error(ErrorCode::file_malformed, "byte 0", [&] { read(test::write_text("text.grid", "NDIME= 3\n")); });
  for (const std::string name : {"points_yc", "boundarymarker_of_surfaces"}) {
    write(test::hexahedron_with_roof(), folder / "mesh.taumesh");
    std::string bytes = test::bytes_of(folder / "mesh.taumesh");
    ASSERT_NE(bytes.find(name), std::string::npos);
    bytes[bytes.find(name)] = 'x';
    std::ofstream(folder / "mesh.taumesh", std::ios::binary) << bytes;
    test::expect_error(ErrorCode::file_malformed, "variable \"" + name + "\": there is none", [&] { read(folder / "mesh.taumesh"); });
  }
}

TEST(TauWrite, AnInterfaceIsTold) {
  HybridMesh mesh = test::hexahedron_with_roof();
  mesh.patches[PatchId(1)] = {"inner", PatchKind::interface};
  const auto path = test::scratch() / "mesh.grid";
  EXPECT_THAT(test::warnings_of_writing(mesh, path),
              testing::ElementsAre("patch \"inner\" is an interface, for which TAU has no condition; it is written as an euler wall"));
  EXPECT_EQ(read(path).patches[PatchId(1)], (Patch{"inner", PatchKind::slip}));
}

TEST(TauRead, NeverCrashesOnDamagedFiles) {
  const auto folder = test::scratch();
  write(test::hexahedron_with_roof(), folder / "mesh.taumesh");
  test::expect_survives_damage(folder / "mesh.taumesh", "damaged.taumesh", test::k_few_attempts);
  if (test::has_shared_data()) test::expect_survives_damage(test::shared_data() / "formats/pt.classic.grid", "damaged.grid", test::k_few_attempts);
}

}  // namespace
}  // namespace sterna::io
