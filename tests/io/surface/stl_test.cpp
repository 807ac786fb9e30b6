#include <cstdint>
#include <cstring>
#include <limits>

#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::test {
namespace {

std::string facet(const std::string& z) {
  return "facet normal 0 0 1\nouter loop\nvertex 0 0 " + z + "\nvertex 1 0 " + z + "\nvertex 0 1 " + z + "\nendloop\nendfacet\n";
}

std::string binary(std::uint32_t n_announced, std::size_t n_facets, float z = 1.0f, const std::string& header = "binary") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  const auto add = [&bytes](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  add(n_announced);
  for (std::size_t i = 0; i < n_facets; ++i) {
    for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, z, 1.f, 0.f, z, 0.f, 1.f, z}) add(value);
    add(std::uint16_t{0x8001});
  }
  return bytes;
}

void refused_stl(const std::string& content, const std::vector<std::string>& texts) { expect_refused("a.stl", content, ErrorCode::file_malformed, texts); }

TEST(SurfaceStl, SolidsArePatches) {
  const SurfaceSoup soup = read_surface_text("a.stl", "solid left wing\n" + facet("0") + "endsolid left wing\nsolid\n" + facet("1") + facet("2") +
                                                          "endsolid\nsolid left wing\n" + facet("3") + "endsolid\n");
  EXPECT_EQ(triangles_by_patch(soup), (std::map<std::string, int>{{"left wing", 2}, {"solid_2", 2}}));
  EXPECT_TRUE(soup.has_names);
  EXPECT_FALSE(soup.single_precision);
}

TEST(SurfaceStl, OneNamelessSolidHasNoName) {
  const SurfaceSoup soup = read_surface_text("a.stl", "solid\n" + facet("0") + "endsolid\n");
  EXPECT_EQ(soup.patch_names, std::vector<std::string>{""});
  EXPECT_FALSE(soup.has_names);
}

TEST(SurfaceStl, SpellingsOfText) {
  std::string upper = "solid x\n" + facet("1e0") + "endsolid x\n";
  const SurfaceSoup soup = read_surface_text("a.stl", upper);
  for (char& c : upper) c = c >= 'a' && c <= 'z' && c != 'x' ? static_cast<char>(c - 'a' + 'A') : c;
  expect_same_soup(read_surface_text("A.STL", upper), soup);
  expect_same_soup(read_surface_text("a.stl", replaced("solid x\n" + facet("1") + "endsolid x\n", "normal 0 0 1", "normal nan -nan 0")), soup);
  expect_same_soup(read_surface_text("a.stl", "\xEF\xBB\xBF  solid \"x\"\n" + facet("+1.0E+00") + "endsolid\n"), soup);
}

TEST(SurfaceStl, TextWithoutEndsolidIsReadWithWarning) {
  std::vector<std::string> warnings;
  EXPECT_EQ(read_surface_text("a.stl", "solid x\n" + facet("0"), &warnings).triangles.size(), 1u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("endsolid"), std::string::npos);
}

TEST(SurfaceStl, BinaryWhateverItsHeaderSays) {
  for (const char* header : {"binary", "solid exported by some program", "COLOR=abcd", ""}) {
    const SurfaceSoup soup = read_surface_text("a.stl", binary(3, 3, 0.1f, header));
    EXPECT_EQ(soup.triangles.size(), 3u);
    EXPECT_TRUE(soup.single_precision);
    EXPECT_FALSE(soup.has_names);
    EXPECT_EQ(soup.points[0].z, static_cast<double>(0.1f));
  }
}

TEST(SurfaceStl, BytesAfterLastFacetAreIgnoredWithWarning) {
  std::vector<std::string> warnings;
  EXPECT_EQ(read_surface_text("a.stl", binary(2, 2) + "junk", &warnings).triangles.size(), 2u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("4 bytes after the last of 2 facets"), std::string::npos) << warnings[0];
}

TEST(SurfaceStl, MistakesAreTold) {
  refused_stl("solid x\n" + replaced(facet("0"), "vertex 1 0 0", "vertex 1 0,5 0"), {"line 5", "0,5", "decimal point"});
  refused_stl("solid x\n" + replaced(facet("0"), "vertex 1 0 0\n", ""), {"line 6", "\"endloop\"", "\"vertex\""});
  refused_stl("solid x\n" + facet("0").substr(0, facet("0").find("endloop")), {"end of the file", "\"endloop\""});
  refused_stl(binary(5, 3), {"byte 84", "5 times 50 bytes", "cut short"});
  refused_stl(binary(4294967295u, 3), {"byte 84", "4294967295"});
  refused_stl(binary(0, 2), {"byte 80", "found 0"});
  refused_stl("<html>no such page</html>", {"byte 0", "<html>", "\"solid\""});
}

}  // namespace
}  // namespace sterna::test
