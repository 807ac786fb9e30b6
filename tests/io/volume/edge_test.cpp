#include <gmock/gmock.h>

#include <fstream>

#include "io/file/volume_file.h"
#include "tests/io/volume/round_trip.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::io {
namespace {

using test::CellOrder;

using test::read;
using test::write;

using test::replaced;

TEST(Edge, RoundTripOfMixedMeshes) {
  const auto folder = test::scratch();
  for (const std::string name : {"mesh.bmsh", "mesh.v2.bmsh"}) {
    SCOPED_TRACE(name);
    for (const HybridMesh& mesh : {test::six_patch_mesh(" \xC3\xBC"
                                                        "ber"),
                                   test::hexahedra_block(3), test::hexahedron_with_roof()})
      test::expect_round_trip(mesh, folder / name, CellOrder::same);
  }
  EXPECT_THAT(test::files_in(folder), testing::ElementsAre("mesh.aboc", "mesh.bmsh", "mesh.v2.bmsh"));
}

TEST(Edge, SamplesByteForByte) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats", folder = test::scratch();
  for (const std::string body : {"pt", "mix4"}) {
    SCOPED_TRACE(body);
    const HybridMesh text = read(samples / (body + ".amsh"));
    EXPECT_NEAR(test::volume_of(text), body == "pt" ? 2.0 / 3.0 : 1.983333, 1e-6);  // values of docs/method/formats.md, "Sample meshes", to their digits
    EXPECT_NEAR(test::enclosed_volume(text), test::volume_of(text), 1e-14);
    for (const std::string& name : {body + ".bmsh", body + ".v2.bmsh"}) {
      SCOPED_TRACE(name);
      const HybridMesh mesh = read(samples / name);
      EXPECT_EQ(mesh.points, text.points);
      EXPECT_EQ(mesh.prisms, text.prisms);
      EXPECT_EQ(mesh.hexahedra, text.hexahedra);
      EXPECT_EQ(mesh.patches, text.patches);
      write(mesh, folder / name);
      const std::string ours(72, ' '), title = "sample " + body;  // the title is the only difference
      EXPECT_EQ(test::bytes_of(folder / name), replaced(test::bytes_of(samples / name), title + ours.substr(title.size()), "sterna" + ours.substr(6)));
      EXPECT_EQ(test::bytes_of(folder / (body + ".aboc")), test::bytes_of(samples / (body + ".aboc")));
    }
  }
  const HybridMesh mesh = read(samples / "mix4.bmsh");
  EXPECT_EQ(mesh.patches.raw(), (std::vector<Patch>{{"wall", PatchKind::wall}, {"symmetry", PatchKind::symmetry}, {"farfield", PatchKind::farfield}}));
}

TEST(Edge, ConditionsInBinary) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats", folder = test::scratch();
  std::filesystem::copy_file(samples / "pt.bmsh", folder / "a.bmsh");
  EXPECT_EQ(read(folder / "a.bmsh").patches[PatchId(1)], (Patch{"side", PatchKind::wall}));  // no boundary conditions: the kind follows from the name
  std::filesystem::copy_file(samples / "pt.bboc", folder / "a.bboc");
  EXPECT_EQ(read(folder / "a.bmsh").patches[PatchId(1)], (Patch{"side", PatchKind::slip}));
}

/// Reverses the bytes of each number in a version 1 file.
std::string little_endian(const std::string& big) {
  std::string bytes = big;
  const auto turn = [&](std::size_t at, std::size_t n) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(at + n));
  };
  const auto number = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(big[at + k]);
    return value;
  };
  for (std::size_t at = 0; at < big.size();) {
    const char type = big[at + 4 + 16];
    const std::size_t n = number(at + 24) * number(at + 28);
    for (const std::size_t location : {at, at + 24, at + 28, at + 32, at + 36}) turn(location, 4);
    at += 40;
    if (n == 0) continue;
    const std::size_t n_bytes = number(at), size = type == 'D' ? 8 : type == 'I' ? 4 : 1;
    turn(at, 4);
    for (std::size_t k = 0; k < n_bytes; k += size) turn(at + 4 + k, size);
    turn(at + 4 + n_bytes, 4);
    at += 8 + n_bytes;
  }
  return bytes;
}

TEST(Edge, LittleEndianFilesAreRead) {
  const auto path = test::scratch() / "mesh.bmsh";
  const HybridMesh mesh = test::six_patch_mesh();
  write(mesh, path);
  const std::string bytes = little_endian(test::bytes_of(path));
  std::ofstream(path, std::ios::binary) << bytes;
  test::expect_same_after_reading(read(path), mesh, CellOrder::same);
}

TEST(Edge, FilesWithoutRegionAreRead) {
  STERNA_NEEDS_SHARED_DATA();
  std::string text = test::bytes_of(test::shared_data() / "formats" / "pt.amsh");
  text = replaced(text, "unstr_grid_data, N, 0, 0, 2", "* a comment\nunstr_grid_data N 0 0 8");
  text = replaced(text, "region, N, 0, 0, 7\n", "");
  const HybridMesh mesh = read(test::write_text("pt.amsh", text));
  EXPECT_EQ(count_cells(mesh).total(), 2);
  EXPECT_EQ(mesh.patches.size(), 3u);
}

TEST(Edge, KindsThatAreLostAreTold) {
  const auto path = test::scratch() / "mesh.bmsh";
  HybridMesh mesh = test::hexahedron_with_roof();
  mesh.patches.raw() = {{"middle", PatchKind::symmetry}, {"inner", PatchKind::interface}};
  EXPECT_THAT(test::warnings_of_writing(mesh, path),
              testing::ElementsAre("patch \"middle\" (symmetry) is written with the Edge condition wall / weak euler, which is read as slip",
                                   "patch \"inner\" (interface) is written with the Edge condition wall / weak euler, which is read as slip"));
  mesh.patches.raw() = {{"symmetry", PatchKind::symmetry}, {"slip", PatchKind::slip}};
  EXPECT_THAT(test::warnings_of_writing(mesh, path), testing::IsEmpty());
  EXPECT_EQ(read(path).patches.raw(), mesh.patches.raw());
}

TEST(Edge, HostileFiles) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats";
  const std::string text = test::bytes_of(samples / "pt.amsh");
  const auto wrong = [&](const std::string& from, const std::string& to, const std::string& message) {
    SCOPED_TRACE(to);
    test::expect_error(ErrorCode::file_malformed, message, [&] { read(test::write_text("pt.amsh", replaced(text, from, to))); });
  };
  wrong("unstr_grid_data", "other", "expected \"unstr_grid_data\"");
  wrong("coordinates, DF, 3, 7, 0", "coordinates, DF, 3, 8, 0", "expected a value of \"coordinates\"");
  wrong("coordinates, DF, 3, 7, 0", "coordinates, DF, 3, 9000000000, 0", "announced");
  wrong("coordinates, DF", "points, DF", "found no \"coordinates\"");
  wrong("coordinates, DF, 3, 7", "coordinates, DF, 7, 3", "found 7 columns, expected the 3");
  wrong("'penta6'", "'penta7'", "found elements of the type \"penta7\"");
  wrong("'tetra4'", "'penta5'", "found 4 columns, expected 5");
  wrong("'tria3'", "'quad4'", "found 3 columns, expected 4");
  wrong("boundary_name", "name", "found no \"boundary_name\"");
  wrong("title, L, 1, 1, 0", "title, Q, 1, 1, 0", "values of the type \"Q\"");
  wrong("title, L, 1, 1, 0", "title, L, 1, 1", "expected a node");
  wrong("'sample pt'", "sample pt", "single quotes");
  test::expect_error(ErrorCode::file_malformed, "after the end", [&] { read(test::write_text("pt.amsh", text + "more N 0 0 0\n")); });
  for (const std::string name : {"pt.bmsh", "pt.v2.bmsh", "pt.amsh"}) {
    const auto path = test::write_text(name, test::bytes_of(samples / name));
    test::expect_no_crash_on_damage(path, 13);
  }
  std::string nested;
  for (int i = 0; i < 1000; ++i) nested += "a N 0 0 1\n";
  test::expect_error(ErrorCode::file_malformed, "deeper", [&] { read(test::write_text("deep.amsh", nested)); });
}

TEST(Edge, LimitsAndFullDisks) {
  const auto folder = test::scratch();
  HybridMesh mesh = test::six_patch_mesh();
  write(mesh, folder / "mesh.bmsh");
  const std::string bytes = test::bytes_of(folder / "mesh.bmsh"), conditions = test::bytes_of(folder / "mesh.aboc");
  {
    const test::FullDisk full(2000);
    test::expect_error(ErrorCode::write_failed, "", [&] { write(test::hexahedra_block(8), folder / "mesh.bmsh"); });
  }
  EXPECT_EQ(test::bytes_of(folder / "mesh.bmsh"), bytes);
  EXPECT_EQ(test::bytes_of(folder / "mesh.aboc"), conditions);
  EXPECT_THAT(test::files_in(folder), testing::ElementsAre("mesh.aboc", "mesh.bmsh"));
  mesh.points[NodeId(4)].y = std::numeric_limits<double>::infinity();
  test::expect_error(ErrorCode::mesh_invalid, "node 4 are not finite", [&] { write(mesh, folder / "other.bmsh"); });
}

}  // namespace
}  // namespace sterna::io
