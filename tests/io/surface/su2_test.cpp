#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::test {
namespace {

/// Returns a tetrahedron with two markers.
const std::string k_tetrahedron =
    "NDIME= 3\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nNELEM= 1\n10 0 1 2 3\n"
    "NMARK= 2\nMARKER_TAG= wing\nMARKER_ELEMS= 3\n5 0 2 1\n5 0 1 3\n5 0 3 2\nMARKER_TAG= tip\nMARKER_ELEMS= 1\n5 1 2 3\n";

SurfaceSoup read_su2(const std::string& text) { return read_surface_text("mesh.su2", text); }
void refused_su2(const std::string& text, const std::vector<std::string>& texts, ErrorCode code = ErrorCode::file_malformed) {
  expect_refused("mesh.su2", text, code, texts);
}

TEST(SurfaceSu2, MarkersArePatches) {
  const SurfaceSoup soup = read_su2(k_tetrahedron);
  EXPECT_EQ(soup.patch_names, (std::vector<std::string>{"wing", "tip"}));
  EXPECT_EQ(triangles_by_patch(soup), (std::map<std::string, int>{{"wing", 3}, {"tip", 1}}));
  EXPECT_TRUE(soup.has_names);
  EXPECT_FALSE(soup.single_precision);
  EXPECT_NEAR(volume_of(soup), 1.0 / 6.0, 1e-15);
}

TEST(SurfaceSu2, SpellingsInTheWildAreTheSameFile) {
  const SurfaceSoup soup = read_su2(k_tetrahedron);
  std::string glued = k_tetrahedron, spaced = k_tetrahedron, indented;
  for (std::size_t at = 0; (at = glued.find("= ", at)) != std::string::npos;) glued.erase(at + 1, 1);
  for (std::size_t at = 0; (at = spaced.find("= ", at)) != std::string::npos; at += 3) spaced.insert(at, " ");
  for (const char c : k_tetrahedron) indented += c == '\n' ? std::string("  \n\t ") : std::string(1, c);
  expect_same_soup(read_su2(glued), soup);
  expect_same_soup(read_su2(spaced), soup);
  expect_same_soup(read_su2(indented), soup);
  expect_same_soup(read_su2(replaced(k_tetrahedron, "NPOIN= 4", "NPOIN= 4 4")), soup);
  expect_same_soup(read_su2(replaced(k_tetrahedron, "1 0 0\n", "1 0 0 1 7\n")), soup);
  expect_same_soup(read_su2(replaced(k_tetrahedron, "5 1 2 3\n", "5 1 2 3 0\n")), soup);
  expect_same_soup(read_su2(replaced(k_tetrahedron, "1 0 0\n", "1.0D+0, 0., -0e-400\n")), soup);
  expect_same_soup(read_su2("% comment\n\n" + replaced(k_tetrahedron, "NELEM", "%\n% elements = 1\n%\nNELEM")), soup);
  expect_same_soup(read_su2(replaced(k_tetrahedron, "NMARK= 2\n", "NMARK= 3\nMARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 2\nSEND_TO= -1\n1 0 0 0\n1 1 0 0\n")),
                   soup);
  expect_same_soup(
      read_su2("NZONE= 1\nIZONE= 1\n" + k_tetrahedron + "NPERIODIC= 1\nPERIODIC_INDEX= 0\n0 0 0\n0 0 0\n0 0 0\nFFD_NBOX= 1\nFFD_CORNER_POINTS= 1\n1 2 3\n"),
      soup);
}

TEST(SurfaceSu2, BlocksComeInAnyOrder) {
  const std::string points = "NPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n", elements = "NELEM= 1\n10 0 1 2 3\n";
  const std::string markers = k_tetrahedron.substr(k_tetrahedron.find("NMARK"));
  const SurfaceSoup soup = read_su2(k_tetrahedron);
  expect_same_soup(read_su2("NDIME= 3\n" + elements + points + markers), soup);
  expect_same_soup(read_su2("NDIME= 3\n" + markers + elements + points), soup);
}

TEST(SurfaceSu2, BlanksInNamesAndEmptyMarkersAreRemoved) {
  std::string text = replaced(k_tetrahedron, "MARKER_TAG= wing", "MARKER_TAG=  left wing ");
  text = replaced(text, "NMARK= 2\n", "NMARK= 3\nMARKER_TAG= nothing\nMARKER_ELEMS= 0\n");
  EXPECT_EQ(read_su2(text).patch_names, (std::vector<std::string>{"leftwing", "tip"}));
}

TEST(SurfaceSu2, PointsOffTheMarkersAreDropped) {
  std::string text = replaced(k_tetrahedron, "NPOIN= 4\n", "NPOIN= 5\n9 9 9\n");
  for (const auto& [from, to] : std::initializer_list<std::pair<const char*, const char*>>{
           {"5 0 2 1", "5 1 3 2"}, {"5 0 1 3", "5 1 2 4"}, {"5 0 3 2", "5 1 4 3"}, {"5 1 2 3\n", "5 2 3 4\n"}})
    text = replaced(text, from, to);
  expect_same_soup(read_su2(text), read_su2(k_tetrahedron));
}

TEST(SurfaceSu2, WithoutMarkersTheElementsAreTheSurface) {
  const SurfaceSoup soup = read_su2("NDIME= 3\nNELEM= 2\n5 0 1 2\n9 0 1 3 2\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n1 1 0\nNMARK= 0\n");
  EXPECT_EQ(soup.triangles.size(), 3u);
  EXPECT_EQ(soup.patch_names, std::vector<std::string>{""});
  EXPECT_FALSE(soup.has_names);
}

TEST(SurfaceSu2, ZonesAreJoined) {
  // Node numbers start at 0 in each zone; markers of the same name become one patch.
  const std::string moved = replaced(replaced(k_tetrahedron, "MARKER_TAG= tip", "MARKER_TAG= tail"), "0 0 0\n", "0 0 -1\n");
  const SurfaceSoup soup = read_su2("NZONE= 2\nIZONE= 1\n" + k_tetrahedron + "IZONE= 2\n" + moved);
  EXPECT_EQ(soup.points.size(), 8u);
  EXPECT_EQ(triangles_by_patch(soup), (std::map<std::string, int>{{"wing", 6}, {"tip", 1}, {"tail", 1}}));
  EXPECT_NEAR(volume_of(soup), volume_of(read_su2(k_tetrahedron)) + volume_of(read_su2(moved)), 1e-15);
}

TEST(SurfaceSu2, LinesInMarkersAreLeftOutAndTold) {
  std::vector<std::string> warnings;
  const std::string text =
      "NDIME= 3\nNELEM= 2\n5 0 1 2\n5 1 3 2\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n1 1 0\nNMARK= 1\nMARKER_TAG= edge\nMARKER_ELEMS= 2\n3 0 1\n3 1 3\n";
  const SurfaceSoup soup = read_surface_text("mesh.su2", text, &warnings);
  EXPECT_EQ(soup.triangles.size(), 2u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("2 lines (type 3) in markers"), std::string::npos) << warnings[0];
}

TEST(SurfaceSu2, FacesBesideMarkersAreOmittedWithWarning) {
  std::vector<std::string> warnings;
  const SurfaceSoup soup = read_surface_text("mesh.su2", replaced(k_tetrahedron, "NELEM= 1\n", "NELEM= 2\n5 0 1 2\n"), &warnings);
  expect_same_soup(soup, read_su2(k_tetrahedron));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("1 faces among the elements"), std::string::npos) << warnings[0];
}

TEST(SurfaceSu2, MistakesAreToldWithTheirLine) {
  refused_su2(replaced(k_tetrahedron, "1 0 0\n", "1 x 0\n"), {"line 4", "\"x\"", "a coordinate of node 1"});
  refused_su2(replaced(k_tetrahedron, "1 0 0\n", "1 0\n"), {"line 4", "end of the line"});
  refused_su2(replaced(k_tetrahedron, "5 1 2 3\n", "5 1 2 4\n"), {"line 17", "found 4", "from 0 to 3"});
  refused_su2(replaced(k_tetrahedron, "5 1 2 3\n", "5 1 2 -3\n"), {"line 17", "-3"});
  refused_su2(replaced(k_tetrahedron, "5 1 2 3\n", "1 1\n"), {"line 17", "type 1", "\"tip\""});
  refused_su2(replaced(k_tetrahedron, "10 0 1 2 3\n", "77 0 1 2 3\n"), {"line 8", "type 77"});
  refused_su2(replaced(k_tetrahedron, "NPOIN= 4", "NPOIN= 3"), {"line 6", "NPOIN= in line 2 announces fewer lines"});
  refused_su2(replaced(k_tetrahedron, "NPOIN= 4", "NPOIN= 5"), {"line 7", "after 4 of the 5 lines"});
  refused_su2(replaced(k_tetrahedron, "NPOIN= 4", "NPOIN= many"), {"line 2", "\"many\""});
  refused_su2(replaced(k_tetrahedron, "NPOIN= 4", "NPOIN= 99999999999999999999"), {"line 2"});
  refused_su2(replaced(k_tetrahedron, "NMARK= 2", "NMARK= 3"), {"found 2 markers", "expected 3", "cut short"});
  refused_su2(replaced(k_tetrahedron, "MARKER_ELEMS= 3\n", ""), {"line 11", "MARKER_ELEMS= of marker \"wing\""});
  refused_su2(k_tetrahedron + "NPOIN= 0\n", {"line 18", "a second NPOIN=", "line 2"});
  refused_su2("NDIME= 3\nNPOIN= 1\n0 0 0\n", {"without NELEM="});
  refused_su2("NDIME= 3\n", {"without NPOIN="});
  refused_su2(replaced(k_tetrahedron, "NDIME= 3", "NDIME= 4"), {"line 1", "expected 3"});
  refused_su2(replaced(k_tetrahedron, "NDIME= 3", "NDIME= 2"), {"line 1", "plane"}, ErrorCode::unsupported_format);
  refused_su2("NZONE= 2\nIZONE= 1\n" + k_tetrahedron, {"found 1 zones", "expected 2 (NZONE=)", "cut short"});
  refused_su2("NZONE= 2\nIZONE= 1\n" + k_tetrahedron + "IZONE= 2\n", {"without NPOIN="});
}

}  // namespace
}  // namespace sterna::test
