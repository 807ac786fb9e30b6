#include <gmock/gmock.h>

#include <fstream>

#include "io/file/volume_file.h"
#include "tests/io/volume/round_trip.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/openfoam_tools.h"

namespace sterna::io {
namespace {

using test::CellOrder;

using test::read;
using test::write;

TEST(Foam, RoundTripOfMixedMeshes) {
  const auto folder = test::scratch();
  for (const std::string name : {"text.foam", "binary.foam"}) {
    SCOPED_TRACE(name);
    std::filesystem::create_directories(folder / name);  // same name as a file in the folder
    for (const HybridMesh& mesh :
         {test::six_patch_mesh(), test::hexahedra_block(3), test::hexahedron_with_roof(), test::sphere_shell(4, {.n_layers = 5, .collapsed = {3, 50, 51}})})
      test::expect_round_trip(mesh, folder / name / name, CellOrder::rotated);
  }
  test::expect_round_trip(test::six_patch_mesh(), folder / "a" / "case" / "constant" / "polyMesh", CellOrder::rotated);
}

TEST(Foam, SamplesByteForByte) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats", folder = test::scratch();
  for (const std::string body : {"pt", "mix4"}) {
    SCOPED_TRACE(body);
    HybridMesh mesh = read(samples / (body + ".foam"));
    EXPECT_EQ(count_cells(mesh).total(), body == "pt" ? 2 : 4);
    EXPECT_NEAR(test::volume_of(mesh), body == "pt" ? 2.0 / 3.0 : 1.983333, 1e-6);  // values of docs/method/formats.md, "Sample meshes", to their digits
    EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-14);
    EXPECT_EQ(mesh.patches[PatchId(0)], (Patch{"wall", PatchKind::wall}));
    EXPECT_EQ(read(samples / (body + ".foam") / "constant" / "polyMesh/").points, mesh.points);
    if (body == "mix4") continue;  // the generator numbers its cells: hexahedron, prism, pyramid, tetrahedron
    write(mesh, folder / "out.text.foam");
    for (const char* const name : {"points", "faces", "owner", "neighbour"})
      EXPECT_EQ(test::bytes_of(folder / "constant" / "polyMesh" / name), test::bytes_of(samples / "pt.foam" / "constant" / "polyMesh" / name));
  }
}

TEST(Foam, ZonesThatAreLeftOutAreNamed) {
  const auto folder = test::scratch();
  write(test::six_patch_mesh(), folder / "out.text.foam");
  const auto header = [](const std::string& name) {
    return "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class regIOobject;\n    object " + name + ";\n}\n";
  };
  std::ofstream(folder / "constant" / "polyMesh" / "cellZones")
      << header("cellZones")
      << "2\n(\nlayers\n{\n    type cellZone;\n    cellLabels List<label> 1(0);\n}\nrotor\n{\n    type cellZone;\n    cellLabels List<label> "
         "1(0);\n}\n)\n";
  std::ofstream(folder / "constant" / "polyMesh" / "faceZones")
      << header("faceZones") << "1(fan{type faceZone; faceLabels List<label> 1(0); flipMap List<bool> 1(0);})\n";
  std::string warnings;
  const RunContext context({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                              if (level == LogLevel::warning) warnings += std::string(line) + "\n";
                            }});
  read_volume_file(folder / "out.text.foam", context);
  EXPECT_THAT(warnings, testing::AllOf(testing::HasSubstr("cellZones: 1 zone of cells (\"rotor\") is left out"),
                                       testing::HasSubstr("faceZones: 1 zone of faces (\"fan\") is left out"), testing::Not(testing::HasSubstr("layers"))));
}

TEST(Foam, CheckMeshFindsNothing) {
  const auto folder = test::scratch();
  const HybridMesh mesh = test::six_patch_mesh();
  for (const std::string name : {"text.foam", "binary.foam"}) {
    test::make_foam_case(folder / name);
    write(mesh, folder / name);
    const auto output = test::run_openfoam("checkMesh", {"-case", name, "-allTopology", "-allGeometry"}, folder);
    STERNA_NEEDS(output, "the Debian package openfoam");
    const CellCounts counts = count_cells(mesh);
    EXPECT_EQ(test::number_after(*output, "prisms:"), static_cast<double>(counts.prisms));
    EXPECT_EQ(test::number_after(*output, "pyramids:"), static_cast<double>(counts.pyramids));
    EXPECT_EQ(test::number_after(*output, "tetrahedra:"), static_cast<double>(counts.tetrahedra));
    EXPECT_EQ(test::number_after(*output, "    points:"), static_cast<double>(mesh.points.size()));
    test::expect_clean(*output, {"small determinant"});
  }
}

TEST(Foam, HostileFiles) {
  const auto scratch = test::scratch(), folder = scratch / "case.text.foam", poly = scratch / "constant" / "polyMesh";
  write(test::hexahedron_with_roof(), folder);
  const auto wrong = [&](const std::string& file, const std::string& from, const std::string& to, const std::string& message,
                         ErrorCode code = ErrorCode::file_malformed) {
    SCOPED_TRACE(file + ": " + to);
    const std::string bytes = test::bytes_of(poly / file);
    std::string text = bytes;
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    std::ofstream(poly / file, std::ios::binary) << text.replace(at, from.size(), to);
    test::expect_error(code, message, [&] { read(folder); });
    std::ofstream(poly / file, std::ios::binary) << bytes;
  };
  wrong("points", "vectorField", "labelList", "found the class \"labelList\", expected vectorField");
  wrong("points", "9\n(", "999999999\n(", "999999999 as the number of points");
  wrong("points", "(0.5 0.5 1.5)", "(0.5 nan 1.5)", "line 20");
  wrong("points", "(0.5 0.5 1.5)", "(0.5 0.5)", "found \")\", expected a coordinate");
  wrong("points", "ascii", "binary", "byte");
  wrong("faces", "4(", "4000000(", "as the number of nodes of a face");
  wrong("faces", "4(", "7(", "expected a node of a face");
  wrong("faces", "3(", "2(", "expected \")\"");
  wrong("owner", "\n1\n", "\n10\n", "found 10 as the cell of a face");
  wrong("owner", "\n1\n", "\n0\n", "faces");
  wrong("owner", "10\n(", "9\n(", "expected \")\"");
  wrong("neighbour", "1\n(\n1\n)", "4000000000{1}", "expected at most 10");
  wrong("boundary", "startFace 1", "startFace 2", "starts at face 2, expected 1");
  wrong("boundary", "nFaces 4", "nFaces 400", "ends after the last face");
  wrong("boundary", "nFaces", "nfaces", "has no type, nFaces or startFace");
  for (const std::string name : {"points", "faces", "owner", "neighbour", "boundary"}) {
    std::filesystem::rename(poly / name, poly / "away");
    test::expect_error(ErrorCode::file_not_found, name, [&] { read(folder); });
    std::filesystem::rename(poly / "away", poly / name);
  }
  read(folder);
}

TEST(Foam, NeverCrashesOnDamagedFiles) {
  for (const std::string name : {"case.text.foam", "case.foam"}) {
    const auto scratch = test::scratch(), folder = scratch / name;
    write(test::hexahedron_with_roof(), folder);
    for (const std::string file : {"points", "faces", "owner", "neighbour", "boundary"}) {
      const auto path = scratch / "constant" / "polyMesh" / file;
      const std::string bytes = test::bytes_of(path);
      for (std::size_t n = 0; n < 2 * bytes.size(); n += 11) {
        std::string damaged = n < bytes.size() ? bytes.substr(0, n) : bytes;
        if (n >= bytes.size()) damaged[n - bytes.size()] = static_cast<char>(damaged[n - bytes.size()] ^ 0x15);
        std::ofstream(path, std::ios::binary) << damaged;
        try {
          read(folder);
        } catch (const Error& error) {
          EXPECT_TRUE(error.code() == ErrorCode::file_malformed || error.code() == ErrorCode::unsupported_format) << error.what();
        }
      }
      std::ofstream(path, std::ios::binary) << bytes;
    }
  }
}

/// The file that ParaView opens and OpenFOAM's tools find: an empty file beside constant/.
TEST(Foam, FileIsParaViewCaseFoldersStayCases) {
  const auto scratch = test::scratch();
  const auto poly_of = [](const std::filesystem::path& folder) { return folder / "constant" / "polyMesh"; };
  write(test::hexahedra_block(2), scratch / "case.foam");
  EXPECT_THAT(test::files_in(scratch), testing::ElementsAre("case.foam", "constant", "system"));
  EXPECT_EQ(std::filesystem::file_size(scratch / "case.foam"), 0u);
  EXPECT_EQ(read(scratch / "case.foam").points, read(poly_of(scratch)).points);
  test::expect_error(ErrorCode::file_not_found, "other.foam: there is no such file", [&] { read(scratch / "other.foam"); });
  test::expect_error(ErrorCode::write_failed, "belongs to case.foam", [&] { write(test::six_patch_mesh(), scratch / "other.foam"); });
  EXPECT_EQ(read(scratch / "case.foam").points, test::hexahedra_block(2).points);
  EXPECT_FALSE(std::filesystem::exists(scratch / "other.foam"));
  write(test::six_patch_mesh(), scratch / "case.foam");
  EXPECT_EQ(read(scratch / "case.foam").points, test::six_patch_mesh().points);

  // A folder is a case regardless of its name.
  std::filesystem::create_directories(scratch / "old.foam");
  write(test::hexahedra_block(2), scratch / "old.foam");
  EXPECT_THAT(test::files_in(scratch / "old.foam"), testing::ElementsAre("constant", "system"));
  EXPECT_EQ(read(scratch / "old.foam").points, read(poly_of(scratch / "old.foam")).points);
  write_volume_file(test::hexahedra_block(2), scratch / "plain", RunContext({.threads = 2}), "OpenFOAM");
  EXPECT_THAT(test::files_in(scratch / "plain"), testing::ElementsAre("constant", "system"));
}

/// checkMesh can be run on the written case at once; existing settings are kept, and a polyMesh alone does not make a case.
TEST(Foam, FoldersOfCasesAreMade) {
  const auto scratch = test::scratch();
  for (const std::string name : {"case/", "case", "case"}) write(test::hexahedra_block(2), scratch / name);
  EXPECT_THAT(test::files_in(scratch / "case"), testing::ElementsAre("constant", "system"));
  EXPECT_EQ(read(scratch / "case").points, read(scratch / "case" / "").points);
  std::ofstream(scratch / "case" / "system" / "controlDict") << "of the user";
  write(test::hexahedra_block(2), scratch / "case" / "constant" / "polyMesh");
  write(test::hexahedra_block(2), scratch / "case");
  EXPECT_EQ(test::bytes_of(scratch / "case" / "system" / "controlDict"), "of the user");
  write(test::hexahedra_block(2), scratch / "mesh" / "constant" / "polyMesh");
  EXPECT_THAT(test::files_in(scratch / "mesh"), testing::ElementsAre("constant"));
  test::expect_error(ErrorCode::unsupported_format, "the file extension is unknown", [&] { write(test::hexahedra_block(2), scratch / "nocase"); });
  write(test::six_patch_mesh(), scratch / "looked_at/");
  const auto output = test::run_openfoam("checkMesh", {"-case", "looked_at"}, scratch);
  STERNA_NEEDS(output, "the Debian package openfoam");
  EXPECT_THAT(*output, testing::HasSubstr("Mesh OK."));
}

TEST(Foam, OldFolderStaysUntilNewIsComplete) {
  const auto scratch = test::scratch(), folder = scratch / "case.foam", poly = scratch / "constant" / "polyMesh";
  write(test::hexahedron_with_roof(), folder);
  std::ofstream(poly / "cellZones") << "of the old mesh";
  const std::string bytes = test::all_bytes(scratch);
  {
    const test::FullDisk full(2000);
    test::expect_error(ErrorCode::write_failed, "", [&] { write(test::six_patch_mesh(), folder); });
  }
  EXPECT_EQ(test::all_bytes(scratch), bytes);
  EXPECT_EQ(test::files_in(scratch / "constant"), std::vector<std::string>{"polyMesh"});
  write(test::hexahedra_block(2), folder);
  EXPECT_THAT(test::files_in(poly), testing::ElementsAre("boundary", "faces", "neighbour", "owner", "points"));
  EXPECT_EQ(test::files_in(scratch / "constant"), std::vector<std::string>{"polyMesh"});

  const auto other = scratch / "other" / "polyMesh";
  std::filesystem::create_directories(other / "precious");
  test::expect_error(ErrorCode::write_failed, "something else", [&] { write(test::hexahedra_block(2), other); });
  EXPECT_TRUE(std::filesystem::exists(other / "precious"));
}

TEST(Foam, MeshesThatDoNotCloseAreRefused) {
  const auto path = test::scratch() / "case.foam";
  HybridMesh mesh = test::six_patch_mesh();
  mesh.boundary_quads.pop_back();
  test::expect_error(ErrorCode::mesh_invalid, "belongs to one cell only and is not in the boundary", [&] { write(mesh, path); });
  mesh = test::six_patch_mesh();
  mesh.boundary_quads.push_back(mesh.boundary_quads.back());
  test::expect_error(ErrorCode::mesh_invalid, "occurs more than twice", [&] { write(mesh, path); });
  mesh = test::six_patch_mesh();
  mesh.boundary_triangles[0].nodes[0] = NodeId(100000);
  test::expect_error(ErrorCode::mesh_invalid, "100000", [&] { write(mesh, path); });
  mesh = test::six_patch_mesh();
  mesh.points[NodeId(7)].x = std::numeric_limits<double>::quiet_NaN();
  test::expect_error(ErrorCode::mesh_invalid, "node 7 are not finite", [&] { write(mesh, path); });
  EXPECT_FALSE(std::filesystem::exists(path.parent_path() / "constant" / "polyMesh"));
}

TEST(Foam, NamesAreMappedWithAMessage) {
  std::vector<std::string> log;
  HybridMesh mesh = test::hexahedron_with_roof();
  mesh.patches[PatchId(0)].name = "2nd wall; left (\xC3\xBC)";
  mesh.patches[PatchId(1)].name = "";
  const auto path = test::scratch() / "case.foam";
  write_volume_file(mesh, path, RunContext({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                                              if (level == LogLevel::warning) log.emplace_back(line);
                                            }}));
  EXPECT_THAT(log, testing::ElementsAre(testing::HasSubstr("\"_2nd_wall__left__\xC3\xBC_\""), testing::HasSubstr("\"patch_2\"")));
  EXPECT_EQ(read(path).patches[PatchId(0)].name, "_2nd_wall__left__\xC3\xBC_");
}

}  // namespace
}  // namespace sterna::io
