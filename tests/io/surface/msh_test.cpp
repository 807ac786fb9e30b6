#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::test {
namespace {

/// A triangle and a quad in a plane; sparse tags in any order; the second surface has no physical group.
const std::string k_v4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"edge\"\n2 7 \"upper wing\"\n$EndPhysicalNames\n"
    "$Entities\n1 1 2 0\n1 0 0 0 0\n1 0 0 0 1 0 0 1 1 2 1 -1\n3 0 0 0 1 1 0 1 7 1 1\n4 0 0 0 2 1 0 0 0\n$EndEntities\n"
    "$Nodes\n2 5 10 900\n1 1 0 2\n900\n10\n0 0 0\n1 0 0\n2 3 0 3\n40\n20\n30\n0 1 0\n2 0 0\n2 1 0\n$EndNodes\n"
    "$Elements\n3 3 1 3\n1 1 1 1\n1 900 10\n2 3 2 1\n2 900 10 40\n2 4 3 1\n3 10 20 30 40\n$EndElements\n";
const std::string k_v2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"upper wing\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n900 0 0 0\n10 1 0 0\n40 0 1 0\n20 2 0 0\n30 2 1 0\n$EndNodes\n"
    "$Elements\n3\n1 1 2 1 1 900 10\n2 2 2 7 3 900 10 40\n3 3 2 0 4 10 20 30 40\n$EndElements\n";

SurfaceSoup read_msh(const std::string& text) { return read_surface_text("mesh.msh", text); }
void refused_msh(const std::string& text, const std::vector<std::string>& texts, ErrorCode code = ErrorCode::file_malformed) {
  expect_refused("mesh.msh", text, code, texts);
}

TEST(SurfaceMsh, BothVersionsGiveTheSame) {
  const SurfaceSoup soup = read_msh(k_v4);
  EXPECT_EQ(triangles_by_patch(soup), (std::map<std::string, int>{{"upper wing", 1}, {"patch_4", 2}}));
  EXPECT_EQ(soup.points.size(), 5u);
  EXPECT_TRUE(soup.has_names);
  expect_same_soup(read_msh(k_v2), soup);
}

TEST(SurfaceMsh, VersionsOfTheSameLayoutAreRead) {
  for (const char* version : {"2", "2.0", "2.1"}) expect_same_soup(read_msh(replaced(k_v2, "2.2 0 8", std::string(version) + " 0 8")), read_msh(k_v2));
  // Version 2.0 has no dimension in physical names.
  expect_same_soup(read_msh(replaced(replaced(k_v2, "2.2 0 8", "2.0 0 8"), "2 7 \"upper wing\"", "7 \"upper wing\"")), read_msh(k_v2));
}

TEST(SurfaceMsh, NamesNeedNoPhysicalNames) {
  const std::string names = "$PhysicalNames\n2\n1 1 \"edge\"\n2 7 \"upper wing\"\n$EndPhysicalNames\n";
  EXPECT_EQ(triangles_by_patch(read_msh(replaced(k_v4, names, ""))), (std::map<std::string, int>{{"patch_7", 1}, {"patch_4", 2}}));
}

TEST(SurfaceMsh, NegativeGroupTagReversesEntityNotName) {
  expect_same_soup(read_msh(replaced(k_v4, "1 7 1 1\n", "1 -7 1 1\n")), read_msh(k_v4));
  expect_same_soup(read_msh(replaced(k_v2, "2 2 2 7 3", "2 2 2 -7 3")), read_msh(k_v2));
}

TEST(SurfaceMsh, OtherSectionsParametricNodesSecondOrderAreSkipped) {
  expect_same_soup(read_msh(replaced(k_v4, "$Nodes", "$Comments\nanything 1 2 $ 3\n$EndComments\n$Nodes")), read_msh(k_v4));
  expect_same_soup(read_msh(k_v4 + "$NodeData\n1\n\"p\"\n1\n0\n3\n0\n1\n1\n10 3.5\n$EndNodeData\n"), read_msh(k_v4));
  std::string parametric = replaced(k_v4, "1 1 0 2\n900\n10\n0 0 0\n1 0 0\n", "1 1 1 2\n900\n10\n0 0 0 0.5\n1 0 0 0.7\n");
  expect_same_soup(read_msh(parametric), read_msh(k_v4));
  const SurfaceSoup second = read_msh(replaced(k_v2, "2 2 2 7 3 900 10 40", "2 9 2 7 3 900 10 40 20 30 20"));
  EXPECT_EQ(second.triangles.size(), 3u);
  EXPECT_EQ(triangles_by_patch(second), triangles_by_patch(read_msh(k_v2)));
}

TEST(SurfaceMsh, BinarySamplesAreTheTextOnes) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = shared_data() / "formats";
  expect_same_soup(read_surface(samples / "pt.v22bin.msh"), read_surface(samples / "pt.v22.msh"));
  expect_same_soup(read_surface(samples / "mix4.v22bin.msh"), read_surface(samples / "mix4.v22.msh"));
  const SurfaceSoup text = read_surface(samples / "pt.v41.msh"),
                    binary = read_surface(samples / "pt.v41bin.msh");  // gmsh stored the nodes and groups in its own order
  EXPECT_NEAR(volume_of(binary), volume_of(text), 1e-15);
  EXPECT_EQ(binary.triangles.size(), text.triangles.size());
}

TEST(SurfaceMsh, WhatIsNotReadIsNamed) {
  const auto unsupported = ErrorCode::unsupported_format;
  refused_msh(replaced(k_v4, "4.1 0 8", "4.1 1 4"), {"reals of 4 bytes"}, unsupported);
  refused_msh(replaced(k_v4, "4.1 0 8", "4 0 8"), {"version 4", "4.1 and 2 to 2.2"}, unsupported);
  refused_msh(replaced(k_v2, "3 3 2 0 4", "3 93 2 0 4"), {"type 93"}, unsupported);
  refused_msh(replaced(k_v4, "$Entities", "$PartitionedEntities"), {"partition"}, unsupported);
  refused_msh("(0 \"a Fluent file\")\n(2 2)\n", {"2 dimensions"}, unsupported);
}

TEST(SurfaceMsh, MistakesAreToldWithTheirLine) {
  refused_msh("solid wing\n", {"line 1", "\"solid\"", "$MeshFormat"});
  refused_msh(replaced(k_v2, "10 1 0 0", "10 1 0"), {"line 15", "\"$EndNodes\"", "a coordinate of a node"});  // line ends count as blanks
  refused_msh(replaced(k_v2, "10 1 0 0", "900 1 0 0"), {"line 11", "node 900 occurs twice"});
  refused_msh(replaced(k_v2, "900 10 40", "900 10 41"), {"line 19", "node 41"});
  refused_msh(replaced(k_v4, "2 900 10 40", "2 900 10 41"), {"node 41", "$Nodes does not list"});
  refused_msh(replaced(k_v2, "\"upper wing\"", "upper wing"), {"line 6", "double quotes"});
  refused_msh(replaced(k_v2, "$Nodes\n5", "$Nodes\n500"), {"line 9", "found 500", "cut short"});
  refused_msh(replaced(k_v2, "$EndNodes\n", ""), {"line 15", "\"$Elements\"", "$EndNodes"});
  refused_msh(k_v2.substr(0, k_v2.size() - 13), {"the end of the file", "$EndElements"});
  for (const std::string& text : {k_v2, k_v4}) {
    refused_msh(text.substr(0, text.find("$Elements")), {"the end of the file", "the section $Elements", "cut short"});
    refused_msh(text.substr(0, text.find("$Nodes")), {"the section $Nodes"});
  }
  refused_msh(replaced(k_v4, "3 3 1 3\n", "3 4 1 3\n"), {"found 3 elements", "expected 4"});
  refused_msh(replaced(k_v2, "2 2 2 7 3", "2 2 2 -9223372036854775808 3"), {"line 19", "32 bits"});
}

}  // namespace
}  // namespace sterna::test
