// Formats of quad patches (LaWGS, PLOT3D, zml) and dwfs: small hand-made files in tests/data/io, and real files.
#include <gmock/gmock.h>

#include "io/file/format_table.h"
#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::test {
namespace {

using Counts = std::map<std::string, int>;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Wgs, NetworksArePlacedAndMirrorsTold) {
  std::vector<std::string> warnings;
  const SurfaceSoup soup = read_surface(corpus() / "io" / "two_panels.wgs", &warnings);
  EXPECT_EQ(triangles_by_patch(soup), (Counts{{"WING", 4}, {"FIN, turned/moved", 4}}));
  ASSERT_EQ(soup.points.size(), 12u);
  EXPECT_EQ(soup.points[4], (Vec3{0.5, 1, 0.1}));
  // (1, 2, 0) rotated by 90 degrees about x is (1, 0, 2); then moved by 1 along z, then doubled.
  EXPECT_LT(distance(soup.points[11], {2, 0, 6}), 1e-15);
  EXPECT_THAT(warnings, ElementsAre(AllOf(HasSubstr("y = 0"), HasSubstr("WING"))));
}

TEST(Wgs, MistakesAreTold) {
  const std::string good = small_text("two_panels.wgs");
  expect_refused("a.wgs", replaced(good, "'WING  '", "WING"), ErrorCode::file_malformed, {"line 2", "single quotes"});
  expect_refused("a.wgs", replaced(good, "1 2 3 0  0", "1 1 3 0  0"), ErrorCode::file_malformed, {"1 lines of 3"});
  expect_refused("a.wgs", replaced(good, "1 2 3 0  0", "1 200 300 0  0"), ErrorCode::file_malformed, {"line 3"});
  expect_refused("a.wgs", replaced(good, "1 1 1  1\n", "1 1 1  4\n"), ErrorCode::file_malformed, {"global symmetry"});
  expect_refused("a.wgs", "title\n", ErrorCode::file_malformed, {"name of an object"});
}

TEST(Plot3d, TextAndEveryBinaryVariantAgree) {
  SurfaceSoup text = read_surface(corpus() / "io" / "two_blocks.fmt");
  EXPECT_EQ(triangles_by_patch(text), (Counts{{"patch_1", 4}, {"patch_2", 2}}));
  EXPECT_EQ(text.points[5], (Vec3{2, 1, 0.5}));
  EXPECT_EQ(text.points[7], (Vec3{0, 1, 0}));
  for (const auto& [name, is_single] : {std::pair{"two_blocks.records.p3d", false}, {"two_blocks.plain.p3d", true}, {"two_blocks.iblank.xyz", true}}) {
    SCOPED_TRACE(name);
    text.single_precision = is_single;
    expect_same_soup(read_surface(corpus() / "io" / name), text);
  }
}

TEST(Plot3d, MistakesAreTold) {
  const std::string good = small_text("two_blocks.fmt");
  expect_refused("a.fmt", replaced(good, "3 2 1", "3 2 2"), ErrorCode::unsupported_format, {"block 1 is a volume of 3 x 2 x 2"});
  expect_refused("a.fmt", replaced(good, "3 2 1", "3 20 1"), ErrorCode::file_malformed, {"60 points of block 1"});
  expect_refused("a.fmt", replaced(good, "3 2 1", "3 0 1"), ErrorCode::file_malformed, {"dimension of 1 or more"});
  expect_refused("a.fmt", good + " 7", ErrorCode::file_malformed, {"after the last of 2 blocks"});
  const std::string records = small_text("two_blocks.records.p3d");
  expect_refused("a.p3d", records.substr(0, records.size() - 4), ErrorCode::file_malformed, {"byte"});
  expect_refused("a.p3d", records + "x", ErrorCode::file_malformed, {"1 bytes after the last of 2 blocks"});
}

TEST(Zml, SectionsAndConditionsArePatches) {
  const SurfaceSoup soup = read_surface(corpus() / "io" / "pyramid.zml");
  // "roof" has four triangles; elements 2 and 3 of the file are "north"; the quad "floor" is element 0.
  EXPECT_EQ(triangles_by_patch(soup), (Counts{{"floor", 2}, {"roof", 2}, {"north", 2}}));
  EXPECT_DOUBLE_EQ(volume_of(soup), 1.0 / 3.0);
}

TEST(Zml, RealSurface) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = read_surface(shared_data() / "formats" / "real_cube1_surface.zml");
  EXPECT_EQ(soup.points.size(), 3082u);  // docs/method/formats_surfaces.md, "ZML"
  EXPECT_EQ(triangles_by_patch(soup), (Counts{{"PID 1", 6160}}));
}

TEST(Zml, OtherKindsAreNamed) { expect_refused("a.zml", "PK\x03\x04 something", ErrorCode::unsupported_format, {"LZ4 frame"}); }

TEST(Dwfs, TagsAreNamedPatches) {
  EXPECT_EQ(io::format_of(corpus() / "io" / "tetrahedron.msh").name, "dwfs");
  const SurfaceSoup soup = read_surface(corpus() / "io" / "tetrahedron.msh");
  EXPECT_EQ(triangles_by_patch(soup), (Counts{{"hull & keel", 2}, {"patch_7", 2}}));
  EXPECT_DOUBLE_EQ(volume_of(soup), 1.0 / 6.0);
}

TEST(Dwfs, MistakesAreTold) {
  const std::string good = small_text("tetrahedron.msh");
  expect_refused("a.msh", replaced(good, "count=\"4\">0 0 0", "count=\"5\">0 0 0"), ErrorCode::file_malformed, {"<Vertices>", "12 numbers, expected 5"});
  expect_refused("a.msh", replaced(good, "2 0 3", "2 0 4"), ErrorCode::file_malformed, {"face 3 has the corner 4"});
  expect_refused("a.msh", replaced(good, "1 1 7 7", "1 1 7"), ErrorCode::file_malformed, {"<Tags>"});
  expect_refused("a.msh", "<Mesh></Mesh>", ErrorCode::file_malformed, {"no <Triangulation>"});
}

}  // namespace
}  // namespace sterna::test
