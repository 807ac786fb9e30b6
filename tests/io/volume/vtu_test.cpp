#include <gmock/gmock.h>

#include "io/field/trouble_vtu.h"
#include "io/file/volume_file.h"
#include "io/surface/surface_vtu.h"
#include "tests/io/volume/round_trip.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/test_shapes.h"

namespace sterna::io {
namespace {

using test::write;

class VtuReaders : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Independent, VtuReaders, testing::Values("vtk", "meshio"), [](const auto& info) { return std::string(info.param); });

TEST_P(VtuReaders, Agree) {
  const auto path = test::scratch() / "mesh.vtu";
  // The last mesh has arrays of several compressed blocks.
  for (const HybridMesh& mesh : {test::mixed_mesh(), test::hexahedron_with_roof(), test::sphere_shell(28, {.n_layers = 5, .collapsed = {3, 50, 51}})}) {
    write(mesh, path);
    const auto report = test::read_independently(GetParam(), path);
    STERNA_NEEDS(report, "the Python module of the independent reader");
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
      // VTK cuts cells with warped quads into tets of its own choice: volumes agree to a few percent of the warp, and to rounding if quads are flat.
      EXPECT_NEAR(report->number("vtk.volume"), volume, 1e-3 * volume);
      EXPECT_GT(report->number("vtk.smallest"), 0.0);  // VTK's own check of the windings
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
  STERNA_NEEDS(report, "the Python module of the independent reader");
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
  STERNA_NEEDS(report, "the Python module of the independent reader");
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

using test::read;

TEST(VtuRead, RoundTripToTheBit) {
  const auto folder = test::scratch();
  int i = 0;
  for (const HybridMesh& mesh : {test::mixed_mesh(), test::hexahedron_with_roof(), test::sphere_shell(28, {.n_layers = 5, .collapsed = {3, 50, 51}})}) {
    const auto path = folder / (std::to_string(i++) + ".vtu");
    write(mesh, path);
    const HybridMesh back = read(path);
    const HybridMesh expected = explicit_cells(mesh);
    EXPECT_EQ(back.points, expected.points);
    EXPECT_EQ(back.prisms, expected.prisms);
    EXPECT_EQ(back.pyramids, expected.pyramids);
    EXPECT_EQ(back.hexahedra, expected.hexahedra);
    EXPECT_EQ(back.tetrahedra, expected.tetrahedra);
    EXPECT_EQ(back.patches, expected.patches);  // including their kinds
    ASSERT_EQ(back.boundary_triangles.size(), mesh.boundary_triangles.size());
    for (std::size_t f = 0; f < back.boundary_triangles.size(); ++f) {
      EXPECT_EQ(back.boundary_triangles[f].nodes, mesh.boundary_triangles[f].nodes);
      EXPECT_EQ(back.boundary_triangles[f].patch, mesh.boundary_triangles[f].patch);
    }
    EXPECT_EQ(back.boundary_quads.size(), mesh.boundary_quads.size());
    EXPECT_NEAR(test::enclosed_volume(back), test::volume_of(mesh), 1e-12 * test::volume_of(mesh));  // rounding of sums
  }
}

using test::replaced;

TEST(Vtu, EveryPackingHasTheSameContent) {
  const auto folder = test::scratch();
  // The second mesh has arrays of several blocks.
  for (const HybridMesh& mesh : {test::six_patch_mesh(), test::sphere_shell(28, {.n_layers = 5, .collapsed = {3, 50, 51}})}) {
    for (const std::string name : {"mesh.vtu", "mesh.raw.vtu", "mesh.lz4.vtu"}) {
      if (mesh.layers.n_columns() > 1000 && name != "mesh.lz4.vtu") continue;  // to save time
      SCOPED_TRACE(name);
      write(mesh, folder / name);
      test::expect_same_after_reading(read(folder / name), mesh, test::CellOrder::same);
      const auto report = test::read_independently("vtk", folder / name);
      STERNA_NEEDS(report, "the Python module of the independent reader");
      test::expect_same_mesh(*report, mesh);
    }
  }
}

TEST(VtuRead, Samples) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats";
  for (const std::string variant : {"ascii", "b64", "b64zlib", "raw", "raw32", "rawzlib", "rawlz4", "rawlz4_multiblock"}) {
    SCOPED_TRACE(variant);
    HybridMesh mesh = read(samples / ("pt." + variant + ".vtu"));
    EXPECT_EQ(mesh.points.size(), 7u);
    EXPECT_EQ(mesh.prisms.size(), 1u);
    EXPECT_EQ(mesh.tetrahedra.size(), 1u);
    EXPECT_EQ(mesh.boundary_triangles.size(), 4u);
    EXPECT_EQ(mesh.boundary_quads.size(), 3u);
    ASSERT_EQ(mesh.patches.size(), 3u);
    EXPECT_EQ(mesh.patches[PatchId(0)].name, "patch_1");
    EXPECT_NEAR(test::volume_of(mesh), 2.0 / 3.0, 1e-15);
    EXPECT_NEAR(test::enclosed_volume(mesh), 2.0 / 3.0, 1e-15);
    mesh = read(samples / ("mix4." + variant + ".vtu"));
    EXPECT_EQ(count_cells(mesh).total(), 4);
    EXPECT_EQ(mesh.boundary_triangles.size(), 8u);
    EXPECT_EQ(mesh.boundary_quads.size(), 6u);
    EXPECT_NEAR(test::volume_of(mesh), 1.983333, 1e-6);  // value of docs/method/formats.md, "Sample meshes", to its digits
  }
  const std::string lzma = replaced(test::bytes_of(samples / "pt.rawlz4.vtu"), "vtkLZ4DataCompressor", "vtkLZMADataCompressor");
  test::expect_error(ErrorCode::unsupported_format, "vtkLZMADataCompressor", [&] { read(test::write_text("lzma.vtu", lzma)); });
}

/// A tetrahedron with one marked face, in text form.
constexpr const char* k_tet =
    "<?xml version=\"1.0\"?>\n<!-- made by hand --><VTKFile type='UnstructuredGrid' byte_order='LittleEndian'><UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"4\" NumberOfCells=\"3\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 "
    "1</DataArray></Points>\n"
    "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 2 1 3 0 1 2 0 1</DataArray>"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 7 9</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 5 "
    "3</DataArray></Cells>\n"
    "<CellData><DataArray type=\"Int32\" Name=\"ids\" format=\"ascii\">0 7 0</DataArray></CellData></Piece></UnstructuredGrid></VTKFile>\n";

TEST(VtuRead, WindingsAreRepairedAndLinesDropped) {
  std::vector<std::string> log;
  const RunContext context({.threads = 1, .log = [&](LogLevel, std::string_view line) { log.emplace_back(line); }});
  const HybridMesh mesh = read_volume_file(test::write_text("tet.vtu", k_tet), context);
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1.0 / 6.0);
  ASSERT_EQ(mesh.boundary_triangles.size(), 1u);
  EXPECT_EQ(mesh.boundary_triangles[0].nodes, (std::array{NodeId(0), NodeId(2), NodeId(1)}));
  EXPECT_EQ(mesh.patches[PatchId(0)].name, "patch_7");
  EXPECT_THAT(log, testing::ElementsAre(testing::HasSubstr("left out: 1"), testing::HasSubstr("flipped: 1 of kind tetrahedron"),
                                        testing::HasSubstr("turned outwards: 1"), testing::HasSubstr("3 faces belong to one cell and to no patch")));
}

TEST(VtuRead, MistakesAreTold) {
  const auto wrong = [&](const std::string& from, const std::string& to, const std::string& message, ErrorCode code = ErrorCode::file_malformed) {
    SCOPED_TRACE(to);
    test::expect_error(code, message, [&] { read(test::write_text("tet.vtu", replaced(k_tet, from, to))); });
  };
  wrong("0 2 1 3", "0 2 1 4", "cell 0 has the node 4, there are 4");
  wrong("0 2 1 3", "0 2 1 -3", "cell 0 has the node -3");
  wrong("0 2 1 3", "0 2 x 3", "\"connectivity\": found text that is not a number");
  wrong("4 7 9", "3 7 9", "cell 0 has 3 nodes, expected 4");
  wrong("4 7 9", "4 3 9", "cell 1 has the offset 3");
  wrong("4 7 9", "4 7 99", "cell 2 has the offset 99");
  wrong("10 5 3", "10 5", "found 2 types for 3 offsets");
  wrong("10 5 3", "42 5 3", "cell 0 is of VTK type 42", ErrorCode::unsupported_format);
  wrong("0 7 0", "0 7", "found 2 values of \"ids\" for 3 cells");
  wrong("0 0 1</Data", "0 0 nan</Data", "coordinates of point 3 are not finite");
  wrong("0 0 1</Data", "0 0</Data", "not a multiple of 3");
  wrong("Points=\"4\"", "Points=\"5\"", "found 4 points, expected 5");
  wrong("\"connectivity\"", "\"connections\"", "found no array \"connectivity\"");
  wrong("'UnstructuredGrid'", "'PolyData'", "holds \"PolyData\"", ErrorCode::unsupported_format);
  wrong("LittleEndian", "BigEndian", "byte order", ErrorCode::unsupported_format);
  test::expect_error(ErrorCode::file_malformed, "no <Piece>", [] { read(test::write_text("tet.vtu", "<a/>")); });
  test::expect_error(ErrorCode::file_malformed, "ends within a tag", [] { read(test::write_text("tet.vtu", "<a b")); });
}

TEST(VtuRead, NeverCrashesOnDamagedFiles) {
  const auto path = test::scratch() / "mesh.vtu";
  write(test::hexahedron_with_roof(), path);
  const std::string bytes = test::bytes_of(path);
  const auto try_to_read = [](const std::string& damaged) {
    try {
      read(test::write_text("damaged.vtu", damaged));
    } catch (const Error& error) {
      EXPECT_TRUE(error.code() == ErrorCode::file_malformed || error.code() == ErrorCode::unsupported_format) << error.what();
    }
  };
  for (std::size_t n = 1; n < bytes.size(); n += 7) try_to_read(bytes.substr(0, n));
  for (std::size_t n = 0; n < bytes.size(); n += 3) {
    std::string damaged = bytes;
    damaged[n] = static_cast<char>(damaged[n] ^ 0x55);
    try_to_read(damaged);
  }
}

}  // namespace
}  // namespace sterna::io
