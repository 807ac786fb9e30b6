// Elements that surface readers leave out are reported in the log, with their number.
#include <gmock/gmock.h>

#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

/// Returns all lines of the log, notes and warnings.
std::vector<std::string> log_of_reading(const std::string& name, const std::string& content) {
  std::vector<std::string> lines;
  const auto path = scratch() / name;
  write_bytes(path, content);
  const RunContext context({.threads = 1, .log = [&lines](LogLevel, std::string_view text) { lines.emplace_back(text); }});
  io::read_surface_file(path, context);
  return lines;
}

TEST(LeftOut, ObjReportsLinesFreeFormSurfacesOtherNames) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  EXPECT_THAT(log_of_reading("a.obj", head + "f 1 2 3\nl 1 2\nl 2 3\np 1\n"), Contains(AllOf(HasSubstr("left out: 2 lines (l)"), HasSubstr("1 points (p)"))));
  EXPECT_THAT(log_of_reading("a.obj", head + "f 1 2 3\ncstype bspline\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nend\n"),
              Contains(HasSubstr("left out: 1 free-form surfaces (surf)")));
  EXPECT_THAT(log_of_reading("a.obj", head + "g a\nusemtl red\nf 1 2 3\ng b\nusemtl blue\nf 2 4 3\n"),
              Contains(HasSubstr("patches are named by groups; the 2 materials are left out")));
}

TEST(LeftOut, PlyTellsOtherElements) {
  EXPECT_THAT(log_of_reading("a.ply",
                             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                             "property list uchar int vertex_indices\nelement edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n0 1\n1 2\n"),
              Contains(HasSubstr("left out: 2 elements \"edge\"")));
}

TEST(LeftOut, MshTellsLinesSecondOrderAndRegions) {
  const auto msh = [](const std::string& elements) {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0.5 0 0\n6 0 0.5 0\n$EndNodes\n$Elements\n" + elements +
           "$EndElements\n";
  };
  EXPECT_THAT(log_of_reading("a.msh", msh("3\n1 15 2 0 1 1\n2 1 2 0 1 1 2\n3 2 2 1 1 1 2 3\n")), Contains(AllOf(HasSubstr("1 lines"), HasSubstr("1 points"))));
  EXPECT_THAT(log_of_reading("a.msh", msh("1\n1 9 2 1 1 1 2 3 5 6 4\n")), Contains(HasSubstr("mid-side nodes of second-order faces, which become flat")));
  EXPECT_THAT(log_of_reading("a.msh", msh("3\n1 2 2 1 1 1 2 3\n2 4 2 1 1 1 2 3 4\n3 4 2 2 2 1 2 3 4\n")), Contains(HasSubstr("2 regions of cells")));
}

TEST(LeftOut, NastranTellsOtherElementsAndMidSideNodes) {
  const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,.5,0.,0.\nGRID,5,,.5,.5,0.\nGRID,6,,0.,.5,0.\n";
  EXPECT_THAT(log_of_reading("a.nas", grids + "CTRIA6,1,1,1,2,3,4,5,6\nCBAR,2,1,1,2\nCBAR,3,1,2,3\nENDDATA\n"),
              AllOf(Contains(HasSubstr("1 second-order faces")), Contains(HasSubstr("2 elements CBAR"))));
}

TEST(LeftOut, MeditTellsSectionsAndRegions) {
  const std::string log = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  EXPECT_THAT(log_of_reading("a.mesh", log + "Edges\n1\n1 2 1\nTriangles\n1\n1 2 3 1\nTetrahedra\n2\n1 2 3 4 7\n1 2 3 4 8\nEnd\n"),
              AllOf(Contains(HasSubstr("1 sections \"Edges\"")), Contains(HasSubstr("2 references (regions)"))));
}

TEST(LeftOut, TetGenTellsHolesAndRegions) {
  EXPECT_THAT(log_of_reading("a.smesh", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n1 0\n3 1 2 3\n1\n1 0.1 0.1 0.1\n0\n"),
              Contains(HasSubstr("left out: 1 points in holes")));
}

}  // namespace
}  // namespace sterna::test
