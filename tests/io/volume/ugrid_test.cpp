#include "io/format_table.h"
#include "io/volume_file.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"

namespace sterna::io {
namespace {

HybridMesh read(const std::filesystem::path& path) { return read_volume_file(path, RunContext({.threads = 2})); }

TEST(UgridRead, Samples) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats";
  for (const std::string variant : {"lb8", "b8"}) {
    HybridMesh mesh = read(samples / ("pt." + variant + ".ugrid"));
    EXPECT_EQ(count_cells(mesh).total(), 2);
    EXPECT_EQ(mesh.patches.size(), 3u);
    EXPECT_NEAR(test::volume_of(mesh), 2.0 / 3.0, 1e-15);
    EXPECT_NEAR(test::enclosed_volume(mesh), 2.0 / 3.0, 1e-15);
    mesh = read(samples / ("mix4." + variant + ".ugrid"));
    EXPECT_EQ(mesh.pyramids.size(), 1u);
    EXPECT_NEAR(test::volume_of(mesh), 1.983333, 1e-6);  // the figure of formats.md, section 14, to its digits
    EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-14);
  }
  const HybridMesh sphere = read(samples / "sphere_mixed.1.lb8.ugrid");
  EXPECT_EQ(sphere.prisms.size(), 3024u);
  EXPECT_EQ(sphere.tetrahedra.size(), 9072u);
  EXPECT_NEAR(test::enclosed_volume(sphere), test::volume_of(sphere), 1e-12 * test::volume_of(sphere));  // rounding of 1e4 terms
  test::expect_error(ErrorCode::unsupported_format, "write it as .lb8.ugrid", [&] { read(samples / "pt.lb8l.ugrid"); });
}

TEST(UgridRead, NeverCrashesOnCutFiles) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string bytes = test::bytes_of(test::shared_data() / "formats" / "mix4.lb8.ugrid");
  for (std::size_t n = 1; n < bytes.size(); n += 5)
    test::expect_error(ErrorCode::file_malformed, "byte", [&] { read(test::write_text("mesh.lb8.ugrid", bytes.substr(0, n))); });
}

TEST(FormatTable, NamesAreFoundByTheirEnd) {
  EXPECT_EQ(format_of("dir.vtu/Wing.SU2").name, "SU2");
  EXPECT_EQ(format_of("wing.v2.su2.gz").name, "SU2");
  EXPECT_EQ(format_of("wing.LB8.ugrid").name, "UGRID");
  test::expect_error(ErrorCode::unsupported_format, ".su2", [] { format_of("wing"); });
  test::expect_error(ErrorCode::unsupported_format, "formats written: SU2, VTU", [] { write_volume_file({}, "wing.stl", RunContext({.threads = 1})); });
  test::expect_error(ErrorCode::unsupported_format, "not gzipped", [] { write_volume_file({}, "wing.su2.gz", RunContext({.threads = 1})); });
  test::expect_error(ErrorCode::unsupported_format, "formats read: UGRID, SU2, VTU", [] { read_volume_file("wing.stl", RunContext({.threads = 1})); });
}

}  // namespace
}  // namespace sterna::io
