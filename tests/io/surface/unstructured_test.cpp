// Legacy VTK, Nastran, Cart3D, TetGen: variants that are missing in the samples, and faulty files.
#include <gmock/gmock.h>

#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"

namespace sterna::test {
namespace {

using Counts = std::map<std::string, int>;
using ::testing::Contains;
using ::testing::HasSubstr;

TEST(LegacyVtk, StripsPolygonsNamesAndAttributes) {
  const SurfaceSoup soup = read_surface(corpus() / "io" / "strips.vtk");
  // CELL_DATA counts lines, polygons, strips; marker 2 has a name, marker 3 has none.
  EXPECT_EQ(triangles_by_patch(soup), (Counts{{"left side", 2}, {"patch_3", 2}}));
  for (const auto& t : soup.triangles) {
    const Vec3 normal = cross(soup.points[t[1]] - soup.points[t[0]], soup.points[t[2]] - soup.points[t[0]]);
    EXPECT_GT(normal.z, 0.0);  // every second triangle of a strip is reversed
  }
}

TEST(LegacyVtk, VolumesOfEverySample) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* ending : {".ascii.vtk", ".bin.vtk", ".v51.vtk", ".v51bin.vtk"}) {
    SCOPED_TRACE(ending);
    const HybridMesh mesh = io::read_volume_file(shared_data() / "formats" / (std::string("mix4") + ending), RunContext({.threads = 1}));
    const CellCounts cells = count_cells(mesh);
    EXPECT_EQ(cells.total(), 4);
    EXPECT_EQ(cells.prisms, 1);
    EXPECT_EQ(mesh.boundary_triangles.size(), 8u);
    EXPECT_EQ(mesh.boundary_quads.size(), 6u);
    EXPECT_EQ(mesh.patches.size(), 3u);
  }
}

TEST(LegacyVtk, RealFileOfVersion1) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = read_surface(shared_data() / "formats" / "blowGeom.vtk");
  EXPECT_EQ(soup.points.size(), 687u);
  // 1057 cells, 4357 numbers: with t triangles and q quads, t + q = 1057 and 4 t + 5 q = 4357, so q = 129 and t = 928.
  EXPECT_EQ(soup.triangles.size(), 928u + 2 * 129);
}

TEST(LegacyVtk, MistakesAreTold) {
  const std::string good = small_text("strips.vtk");
  expect_refused("a.vtk", replaced(good, "# vtk", "# vtx"), ErrorCode::file_malformed, {"line 1", "# vtk DataFile Version"});
  expect_refused("a.vtk", replaced(good, "POLYDATA", "STRUCTURED_GRID"), ErrorCode::unsupported_format, {"structured_grid"});
  expect_refused("a.vtk", replaced(good, "4 2 3 5 4", "4 2 3 5 6"), ErrorCode::file_malformed, {"node 6, there are 6"});
  expect_refused("a.vtk", replaced(good, "4 2 3 5 4", "5 2 3 5 4"), ErrorCode::file_malformed, {"block at line 16", "beyond the announced 5"});
  expect_refused("a.vtk", replaced(good, "marker 1 3 vtkIdType\n0 2 3", "marker 1 2 vtkIdType\n0 2"), ErrorCode::file_malformed,
                 {"found 2 values of \"marker\" for 3 cells"});
  expect_refused("a.vtk", replaced(good, "float", "floa"), ErrorCode::file_malformed, {"expected a type"});
}

TEST(Vtp, PolyDataIsNoVolume) {
  const std::filesystem::path path = scratch() / "a.vtp";
  TriMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{VertexId(0), VertexId(1), VertexId(2)}};
  mesh.triangle_patch = {PatchId(0)};
  mesh.patches = {{"one & only", PatchKind::symmetry}};
  io::write_surface_file(mesh, path, RunContext({.threads = 1}));
  EXPECT_EQ(triangles_by_patch(read_surface(path)), (Counts{{"one & only", 1}}));
  test::expect_error(ErrorCode::unsupported_format, "volume meshes are not read from VTP",
                     [&] { (void)io::read_volume_file(path, RunContext({.threads = 1})); });
}

TEST(Nastran, FieldsOfEveryKindAndNames) {
  const SurfaceSoup soup = read_surface(corpus() / "io" / "plate.bdf");
  EXPECT_EQ(triangles_by_patch(soup), (Counts{{"upper side", 2}, {"lower", 1}, {"patch_7", 1}}));
  ASSERT_EQ(soup.points.size(), 4u);
  EXPECT_EQ(soup.points[1], (Vec3{1, 0, 0}));
  EXPECT_EQ(soup.points[2], (Vec3{1, 1, 1.5e-3}));
  EXPECT_EQ(soup.points[3], (Vec3{0, 1, -0.25}));
}

TEST(Nastran, CoordinatesKeepTenDigitsAtLeast) {
  TriMesh mesh;
  const std::vector<double> values = {
      0.0, -0.0, 1.0, -1.0 / 3.0, 12345.678901234567, -1.2345678901234567e-11, 9.87654321987654e+102, 2.2250738585072014e-308, 0.1, -99999999.123456789};
  for (const double value : values) mesh.points.push_back({value, 0.0, 0.0});
  mesh.triangles = {{VertexId(0), VertexId(1), VertexId(2)}};
  mesh.triangle_patch = {PatchId(0)};
  mesh.patches = {{"a"}};
  const std::filesystem::path path = scratch() / "digits.nas";
  io::write_surface_file(mesh, path, RunContext({.threads = 1}));
  const SurfaceSoup soup = read_surface(path);
  ASSERT_EQ(soup.points.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(soup.points[i].x, values[i], 1e-9 * std::abs(values[i]));
}

TEST(Nastran, MistakesAreTold) {
  const std::string good = small_text("plate.bdf");
  expect_refused("a.nas", replaced(good, "GRID,1,,0.", "GRID,1,3,0."), ErrorCode::unsupported_format, {"line 6", "coordinate system 3"});
  expect_refused("a.nas", replaced(good, "GRID,1,,0.", "GRID,1,,0.x"), ErrorCode::file_malformed, {"line 6", "coordinate"});
  expect_refused("a.nas", replaced(good, "GRID,20,", "GRID,1,"), ErrorCode::file_malformed, {"line 7", "a second point 1"});
  expect_refused("a.nas", replaced(good, "CTRIA3,2,5,1,30,40", "CTRIA3,2,5,1,30,41"), ErrorCode::file_malformed, {"line 12", "point 41"});
  expect_refused("a.nas", replaced(good, "CTRIA3,2,5,1,30,40", "CTRIA3,2,5,1,30"), ErrorCode::file_malformed, {"line 12", "field 6"});
  expect_refused("a.nas", replaced(good, "CTRIA3,2,5,1,30,40", "INCLUDE 'b.bdf'"), ErrorCode::unsupported_format, {"INCLUDE"});
}

TEST(TetGen, FacetsWithPointsAndSegments) {
  const SurfaceSoup soup = read_surface(corpus() / "io" / "box_part.poly");
  EXPECT_EQ(triangles_by_patch(soup), (Counts{{"patch_8", 2}, {"patch_0", 1}}));
  EXPECT_EQ(soup.points.size(), 5u);
}

TEST(TetGen, NodesInTheirOwnFile) {
  const std::filesystem::path folder = scratch();
  write_bytes(folder / "a.node", "3 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n");
  write_bytes(folder / "a.smesh", "0 3 0 0\n1 0\n3 1\n2 3\n0\n0\n");  // a facet over two lines
  EXPECT_EQ(triangles_by_patch(read_surface(folder / "a.smesh")), (Counts{{"", 1}}));
  std::filesystem::remove(folder / "a.node");
  try {
    read_surface(folder / "a.smesh");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_not_found);
    EXPECT_THAT(error.what(), HasSubstr("a.node"));
  }
}

TEST(TetGen, MistakesAreTold) {
  const std::string good = small_text("box_part.poly");
  expect_refused("a.poly", replaced(good, "3 0 8", "3 1 8"), ErrorCode::unsupported_format, {"a facet with holes"});
  expect_refused("a.poly", replaced(good, "2 0 4", "3 0 1 2"), ErrorCode::unsupported_format, {"several polygons"});
  expect_refused("a.poly", replaced(good, "4 0 1\n", "4 0 5\n"), ErrorCode::file_malformed, {"line 10"});
  expect_refused("a.poly", replaced(good, "2 1 1 0 0 1", "3 1 1 0 0 1"), ErrorCode::file_malformed, {"expected 2, the number of the next node"});
  expect_refused("a.poly", replaced(good, "5 3 1 1", "5 2 1 1"), ErrorCode::unsupported_format, {"plane file"});
}

TEST(Cart3d, MistakesAreTold) {
  constexpr const char* k_good = "3 1\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n4\n";
  EXPECT_EQ(triangles_by_patch(read_surface_text("a.tri", k_good)), (Counts{{"patch_4", 1}}));
  EXPECT_EQ(triangles_by_patch(read_surface_text("a.tri", "3 1\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n")), (Counts{{"", 1}}));
  EXPECT_EQ(read_surface_text("a.triq", "3 1 1\n0 0 0\n1 0 0\n0 1 0\n1 2 3\n4\n0.5\n0.6\n0.7\n").triangles.size(), 1u);
  std::vector<std::string> warnings;
  read_surface_text("a.tri", std::string(k_good) + "5 6\n", &warnings);
  EXPECT_THAT(warnings, Contains(HasSubstr("ignored")));
  expect_refused("a.tri", replaced(k_good, "1 2 3", "1 2 4"), ErrorCode::file_malformed, {"line 5"});
  expect_refused("a.tri", replaced(k_good, "1 2 3", "0 1 2"), ErrorCode::file_malformed, {"counted from 1"});
}

TEST(Cart3d, BigEndianRecords) {
  STERNA_NEEDS_SHARED_DATA();
  std::string bytes = bytes_of(shared_data() / "formats" / "mix4.bin.tri");
  for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4)
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i), bytes.begin() + static_cast<std::ptrdiff_t>(i) + 4);
  expect_same_soup(read_surface_text("big.tri", bytes), read_surface(shared_data() / "formats" / "mix4.bin.tri"));
}

}  // namespace
}  // namespace sterna::test
