#include <gmock/gmock.h>

#include <limits>

#include "io/container/cgns_output.h"
#include "io/file/volume_file.h"
#include "io/volume/volume_cgns.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::io {
namespace {

using test::read;
using test::write;

TEST(CgnsRead, SamplesOfEveryVersionAndContainer) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats";
  // v46 and pt.mixed.v46 have 64-bit integers; library version 3.4 writes pt.mixed.adf2 but cannot read it.
  for (const std::string file : {"pt.hdf5", "pt.adf", "pt.adf2", "pt.legacybc.adf", "pt.elementrange.hdf5", "pt.mixed", "pt.mixed.nooffset.v254", "pt.hdf5.v46",
                                 "pt.adf.v46", "pt.mixed.v46", "pt.mixed.adf2"}) {
    SCOPED_TRACE(file);
    const HybridMesh mesh = read(samples / (file + ".cgns"));
    EXPECT_EQ(mesh.points.size(), 7u);
    EXPECT_EQ(mesh.prisms.size(), 1u);
    EXPECT_EQ(mesh.tetrahedra.size(), 1u);
    EXPECT_EQ(mesh.patches.raw(), (std::vector<Patch>{{"wall", PatchKind::wall}, {"side", PatchKind::symmetry}, {"farfield", PatchKind::farfield}}));
    EXPECT_NEAR(test::volume_of(mesh), 2.0 / 3.0, 1e-15);
    EXPECT_NEAR(test::enclosed_volume(mesh), 2.0 / 3.0, 1e-15);
  }
}

TEST(CgnsRead, RealFiles) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats";
  const HybridMesh cylinder = read(samples / "cylinder3D.cgns");  // boundary conditions given as node lists
  EXPECT_EQ(cylinder.tetrahedra.size(), 27591u);
  std::vector<std::string> names;
  for (const Patch& patch : cylinder.patches) names.push_back(patch.name);
  EXPECT_EQ(names, (std::vector<std::string>{"OUT", "WALL", "IN", "CYLINDER_DOWN", "CYLINDER_UP", "SIDE"}));
  EXPECT_NEAR(test::enclosed_volume(cylinder), test::volume_of(cylinder), 1e-12 * test::volume_of(cylinder));  // rounding of 1e4 terms
  const HybridMesh elbow = read(samples / "cgnslib_vers-3110_hdf5-110.cgns");
  EXPECT_EQ(count_cells(elbow).total(), 13761);
  EXPECT_EQ(elbow.patches.size(), 4u);
  EXPECT_NEAR(test::enclosed_volume(elbow), test::volume_of(elbow), 1e-12 * test::volume_of(elbow));
}

TEST(Cgns, RoundTripToTheBitInBothContainers) {
  const auto folder = test::scratch();
  for (const HybridMesh& mesh :
       {test::mixed_mesh(), test::mesh_of_six_patches(), test::hexahedron_with_roof(), test::sphere_shell(6, {.collapsed = {0, 20, 21}})}) {
    for (const std::string extension : {".cgns", ".adf.cgns"}) {
      SCOPED_TRACE(extension);
      const auto file = folder / ("mesh" + extension);
      write(mesh, file);
      const HybridMesh back = read(file);
      test::expect_equal_meshes(back, mesh);
      const std::string bytes = test::bytes_of(file);
      write(mesh, file, 1);
      EXPECT_TRUE(test::bytes_of(file) == bytes);
      write(back, file, 7);
      EXPECT_TRUE(test::bytes_of(file) == bytes);
    }
  }
  EXPECT_EQ(test::files_in(folder), (std::vector<std::string>{"mesh.adf.cgns", "mesh.cgns"}));
}

TEST(Cgns, RoundTripWith64BitIntegers) {
  const auto file = test::scratch() / "mesh.cgns";
  const RunContext context({.threads = 2});
  write_volume_cgns(test::mesh_of_six_patches(), file, CgnsIntegers::always_64, context);
  test::expect_equal_meshes(read(file), test::mesh_of_six_patches());
  test::expect_error(ErrorCode::unsupported_format, "no 64-bit integers",
                     [&] { write_volume_cgns(test::mixed_mesh(), "mesh.adf.cgns", CgnsIntegers::always_64, context); });
}

TEST(CgnsWrite, CgnscheckFindsNothing) {
  const auto folder = test::scratch();
  for (const HybridMesh& mesh : {test::mixed_mesh(), test::mesh_of_six_patches(), test::hexahedron_with_roof()}) {
    for (const std::string name : {"mesh.cgns", "mesh.adf.cgns"}) {
      SCOPED_TRACE(name);
      write(mesh, folder / name);
      const auto output = test::output_of_tool("cgnscheck", {(folder / name).string()});
      STERNA_NEEDS(output, "cgnscheck of the package cgns-convert");
      EXPECT_THAT(*output, testing::HasSubstr("checking complete"));
      EXPECT_THAT(*output, testing::Not(testing::HasSubstr("WARNING"))) << *output;
      EXPECT_THAT(*output, testing::Not(testing::HasSubstr("ERROR"))) << *output;
    }
  }
}

TEST(CgnsWrite, VtkFindsTheSame) {
  const auto path = test::scratch() / "mesh.cgns";
  for (const HybridMesh& mesh : {test::mixed_mesh(), test::mesh_of_six_patches()}) {
    write(mesh, path);
    const auto report = test::read_independently("vtk-cgns", path);
    STERNA_NEEDS(report, "the Python module of the independent reader");
    test::expect_same_mesh(*report, mesh);
    for (const PatchId patch : mesh.patches.ids()) EXPECT_TRUE(report->has("patch." + mesh.patches[patch].name)) << report->output;
  }
}

TEST(Cgns, UnsupportedNamesAreMappedAndRestored) {
  HybridMesh mesh = test::hexahedron_with_roof();
  const std::string longer = "a patch whose name is longer than thirty-two bytes";
  mesh.patches[PatchId(0)].name = longer + "/1";
  mesh.patches[PatchId(1)].name = longer + "/2";
  for (const std::string name : {"names.cgns", "names.adf.cgns"}) {
    const auto file = test::scratch() / name;
    std::vector<std::string> warnings;
    write_volume_file(mesh, file, RunContext({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                                                if (level == LogLevel::warning) warnings.emplace_back(line);
                                              }}));
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_THAT(warnings[0], testing::HasSubstr(longer + "/1\" is named \"a patch whose name is longer"));
    EXPECT_EQ(read(file).patches, mesh.patches);
  }
  mesh.patches[PatchId(0)].name = "Flügel, 右 – 12345678901234567";  // 33 bytes: truncated before a character
  mesh.patches[PatchId(1)].name = "ZoneBC";
  const auto file = test::scratch() / "names.cgns";
  write(mesh, file);
  EXPECT_EQ(read(file).patches, mesh.patches);
}

TEST(CgnsWrite, RefusesWhatItCannotHold) {
  HybridMesh mesh = test::mixed_mesh();
  mesh.points[NodeId(4)].y = std::numeric_limits<double>::infinity();
  test::expect_error(ErrorCode::mesh_invalid, "node 4 are not finite", [&] { write(mesh, test::scratch() / "mesh.cgns"); });
  mesh.layers.n_layers = std::numeric_limits<int>::max();
  test::expect_error(ErrorCode::overflow, "cannot count beyond 2147483647", [&] { write(mesh, test::scratch() / "mesh.adf.cgns"); });
  test::expect_error(ErrorCode::write_failed, "no_such_folder", [&] { write(test::hexahedron_with_roof(), test::scratch() / "no_such_folder" / "mesh.cgns"); });
  EXPECT_TRUE(test::files_in(test::scratch()).empty());
}

TEST(CgnsRead, OtherFilesAreRefused) {
  const auto folder = test::scratch();
  test::expect_error(ErrorCode::file_malformed, "byte 0", [&] { read(test::write_text("text.cgns", "NDIME= 3\n")); });
  test::expect_error(ErrorCode::file_malformed, "the file is empty", [&] { read(test::write_text("empty.cgns", "")); });
  test::expect_error(ErrorCode::file_not_found, "none.cgns", [&] { read(folder / "none.cgns"); });
  STERNA_NEEDS_SHARED_DATA();
  test::expect_error(ErrorCode::unsupported_format, "structured", [&] { read(test::shared_data() / "surfaces/nasty/mdo_717_cgns_717_wl_L2.cgns"); });
  std::filesystem::copy_file(test::shared_data() / "formats/pt.vtkhdf", folder / "vtk.cgns");
  test::expect_error(ErrorCode::file_malformed, "not CGNS", [&] { read(folder / "vtk.cgns"); });
}

/// Reads a tetrahedron whose four faces are one section "faces", with a boundary condition that lists some of them.
HybridMesh tetrahedron_with(const CgnsOutputNode& condition, std::vector<std::string>* warnings = nullptr) {
  const auto numbers = [](std::vector<std::uint64_t> extents, const std::vector<std::int32_t>& values) {
    return output_numbers(NumberKind::i4, std::move(extents), values);
  };
  CgnsOutputNode zone = cgns_node("Zone", "Zone_t", numbers({1, 3}, {4, 1, 0}));
  zone.children = {cgns_node("ZoneType", "ZoneType_t", output_text("Unstructured")), cgns_node("GridCoordinates", "GridCoordinates_t"),
                   cgns_node("cell", "Elements_t", numbers({2}, {10, 0})), cgns_node("faces", "Elements_t", numbers({2}, {5, 0})),
                   cgns_node("ZoneBC", "ZoneBC_t")};
  for (int axis = 0; axis < 3; ++axis)
    zone.children[1].children.push_back(
        cgns_node(std::string("Coordinate") + "XYZ"[axis], "DataArray_t",
                  output_numbers<float>(NumberKind::f4, {4}, {0, axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f})));
  zone.children[2].children = {cgns_node("ElementRange", "IndexRange_t", numbers({2}, {1, 1})),
                               cgns_node("ElementConnectivity", "DataArray_t", numbers({4}, {1, 3, 2, 4}))};  // flipped
  zone.children[3].children = {cgns_node("ElementRange", "IndexRange_t", numbers({2}, {2, 5})),
                               cgns_node("ElementConnectivity", "DataArray_t", numbers({12}, {1, 2, 3, 1, 2, 4, 2, 3, 4, 3, 1, 4}))};
  zone.children[4].children = {condition};
  CgnsOutputNode base = cgns_node("Base", "CGNSBase_t", numbers({2}, {3, 3}));
  base.children = {zone, cgns_node("lid", "Family_t")};
  base.children[1].children = {cgns_node("FamBC", "FamilyBC_t", output_text("BCFarfield"))};
  CgnsOutputNode root = cgns_node("", "");
  root.children = {cgns_node("CGNSLibraryVersion", "CGNSLibraryVersion_t", output_numbers<float>(NumberKind::f4, {1}, {3.3f})), base};
  const auto path = test::scratch() / "tetrahedron.cgns";
  write_cgns_hdf5(root, path, RunContext({.threads = 1}));
  const HybridMesh mesh = read_volume_file(path, RunContext({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                                                               if (warnings && level == LogLevel::warning) warnings->emplace_back(line);
                                                             }}));
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(test::enclosed_volume(mesh), 1.0 / 6.0);
  return mesh;
}

TEST(CgnsRead, ConditionsListElementsOrNodesInManyWays) {
  const auto condition = [](const std::string& type, std::vector<CgnsOutputNode> children) {
    CgnsOutputNode node = cgns_node("bc", "BC_t", output_text(type));
    node.children = std::move(children);
    return node;
  };
  const auto points = [](const std::string& name, const std::vector<std::int32_t>& values) {
    return cgns_node(name, name.ends_with("Range") ? "IndexRange_t" : "IndexArray_t", output_numbers(NumberKind::i4, {1, values.size()}, values));
  };
  const CgnsOutputNode face_center = cgns_node("GridLocation", "GridLocation_t", output_text("FaceCenter")),
                       lid = cgns_node("FamilyName", "FamilyName_t", output_text("lid"));
  const std::vector<Patch> inflow = {{"faces", PatchKind::wall}, {"bc", PatchKind::inflow}},
                           family = {{"faces", PatchKind::wall}, {"lid", PatchKind::farfield}};
  EXPECT_EQ(tetrahedron_with(condition("BCInflow", {points("PointRange", {4, 5}), face_center})).patches.raw(), inflow);
  EXPECT_EQ(tetrahedron_with(condition("BCInflow", {points("ElementList", {3})})).patches.raw(), inflow);
  EXPECT_EQ(tetrahedron_with(condition("BCInflow", {points("PointList", {2, 3, 4})})).patches.raw(), inflow);  // node numbers
  EXPECT_EQ(tetrahedron_with(condition("FamilySpecified", {points("PointList", {5}), face_center, lid})).patches.raw(), family);
  EXPECT_EQ(tetrahedron_with(condition("BCSymmetryPlane", {points("ElementRange", {2, 5}), lid})).patches.raw(),
            (std::vector<Patch>{{"lid", PatchKind::symmetry}}));
  std::vector<std::string> warnings;
  EXPECT_EQ(tetrahedron_with(condition("BCInflow", {points("ElementList", {1})}), &warnings).patches.raw(), inflow);  // numbers that exclude the cells
  EXPECT_EQ(tetrahedron_with(condition("BCInflow", {points("ElementList", {9})}), &warnings).patches.raw(), (std::vector<Patch>{{"faces", PatchKind::wall}}));
  EXPECT_THAT(warnings,
              testing::IsSupersetOf({testing::HasSubstr("lists volume cells"), testing::HasSubstr("lists no boundary face")}));  // the cell is flipped, too
  test::expect_error(ErrorCode::file_malformed, "/Base/Zone/ZoneBC/bc/PointList: found the node 5, expected 1 to 4",
                     [&] { tetrahedron_with(condition("BCInflow", {points("PointList", {5})})); });
}

/// A wrong number at a location that the message must name.
TEST(CgnsRead, MistakesAreToldWithTheirPath) {
  HybridMesh mesh = test::hexahedron_with_roof();
  const auto file = test::scratch() / "mesh.cgns";
  mesh.pyramids[0][4] = NodeId(99);
  write(mesh, file);
  test::expect_error(ErrorCode::file_malformed, "/Base/Zone1/PYRA_5/ElementConnectivity: element 1 has node 100, expected 1 to 9", [&] { read(file); });
}

TEST(CgnsRead, NeverCrashesOnDamagedFiles) {
  const auto folder = test::scratch();
  write(test::hexahedron_with_roof(), folder / "mesh.cgns");
  write(test::hexahedron_with_roof(), folder / "mesh.adf.cgns");
  std::vector<std::filesystem::path> victims = {folder / "mesh.cgns", folder / "mesh.adf.cgns"};
  if (test::has_shared_data())  // old groups, heaps, 64 bits
    for (const char* name : {"pt.hdf5.cgns", "pt.adf.v46.cgns", "pt.mixed.v46.cgns"}) victims.push_back(test::shared_data() / "formats" / name);
  for (const auto& victim : victims) test::expect_survives_damage(victim, "damaged.cgns", test::k_few_attempts);
}

}  // namespace
}  // namespace sterna::io
