// Meshes with periodic sides: data kept by each file format, and results of other programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geom/mesh/check.h"
#include "geom/mesh/periodic.h"
#include "io/file/volume_file.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/openfoam_tools.h"
#include "tests/support/process.h"
#include "tests/support/test_constants.h"

namespace sterna::io {
namespace {

using testing::HasSubstr;
using testing::Not;

using test::k_context;

/// Returns a plate with layers and tetrahedra above them, whose sides x = 0 and x = 1 are periodic; each side has triangles and quads.
HybridMesh periodic_plate() {
  HybridMesh mesh = test::plate_block(4);
  const PatchId left = mesh.patches.push_back({"left side", PatchKind::interface}), right = mesh.patches.push_back({"right", PatchKind::interface});
  const auto move = [&](auto& face) {
    const auto is_at = [&](double x) { return std::ranges::all_of(face.nodes, [&](NodeId node) { return mesh.points[node].x == x; }); };
    if (is_at(0.0)) face.patch = left;
    if (is_at(1.0)) face.patch = right;
  };
  for (BoundaryTriangle& face : mesh.boundary_triangles) move(face);
  for (BoundaryQuad& face : mesh.boundary_quads) move(face);
  // The faces of the second side are listed in another order and start at other nodes.
  std::ranges::reverse(mesh.boundary_triangles);
  for (BoundaryQuad& face : mesh.boundary_quads)
    if (face.patch == right) std::rotate(face.nodes.begin(), face.nodes.begin() + 1, face.nodes.end());
  mesh.periodic.push_back({left, right, {1, 0, 0}});
  return mesh;
}

using test::write;

TEST(PeriodicMesh, IsValidAndSaysSo) {
  const CheckReport report = check(periodic_plate(), {}, k_context);
  EXPECT_TRUE(report.is_valid()) << to_text(report);
  ASSERT_EQ(report.periodic.size(), 1u);
  EXPECT_EQ(report.periodic[0].first, "left side");
  EXPECT_THAT(to_text(report), HasSubstr("periodic: left side and right"));
  EXPECT_THAT(to_json(report), HasSubstr("\"worst_distance\": 0.0"));
}

TEST(PeriodicMesh, SternaAndOpenFoamKeepThePair) {
  const auto folder = test::scratch();
  const HybridMesh mesh = periodic_plate();
  for (const std::string name : {"plate.sterna", "plate.foam", "plate.bin.foam"}) {
    std::filesystem::create_directories(folder / ("of_" + name));
    const auto file = folder / ("of_" + name) / name;
    write(mesh, file);
    const HybridMesh read = read_volume_file(file, k_context);
    ASSERT_EQ(read.periodic.size(), 1u) << name;
    EXPECT_EQ(read.patches[read.periodic[0].first].kind, PatchKind::interface);
    EXPECT_NEAR(distance(read.periodic[0].translation, {1, 0, 0}), 0.0, 1e-15);
    EXPECT_TRUE(check(read, {}, k_context).is_valid()) << name;
    EXPECT_EQ(check(read, {}, k_context).periodic.size(), 1u) << name;
  }
}

TEST(PeriodicMesh, CheckMeshAcceptsCyclicPatches) {
  const auto folder = test::scratch();
  for (const std::string name : {"text.foam", "binary.bin.foam"}) {
    test::make_foam_case(folder / name);
    write(periodic_plate(), folder / name);
    const auto output = test::run_openfoam("checkMesh", {"-case", name, "-allTopology", "-allGeometry"}, folder);
    STERNA_NEEDS(output, "the Debian package openfoam");
    test::expect_clean(*output, {"small determinant", "non-orthogonal", "interpolation weight", "volume ratio", "skewness", "Concave", "face tets"});
    EXPECT_THAT(*output, HasSubstr("Coupled point location match (average 0) OK."));
  }
  const std::string boundary = test::bytes_of(folder / "text.foam" / "constant" / "polyMesh" / "boundary");
  EXPECT_THAT(boundary, testing::AllOf(HasSubstr("type cyclic;\n        neighbourPatch right;"), HasSubstr("type cyclic;\n        neighbourPatch left_side;")));
}

TEST(PeriodicMesh, CgnsHasTheConnectivity) {
  const auto folder = test::scratch();
  for (const std::string name : {"plate.cgns", "plate.adf.cgns"}) {
    write(periodic_plate(), folder / name);
    const auto output = test::output_of_tool("cgnscheck", {"-V", (folder / name).string()});
    STERNA_NEEDS(output, "cgnscheck of the package cgns-convert");
    EXPECT_THAT(*output, testing::AllOf(HasSubstr("checking complete"), Not(HasSubstr("ERROR")), Not(HasSubstr("WARNING")), HasSubstr("Abutting1to1"))) << name;
  }
}

TEST(PeriodicMesh, OtherFormatsHaveTwoPatches) {
  const auto folder = test::scratch();
  for (const std::string name : {"plate.su2", "plate.vtu", "plate.msh"}) {
    write(periodic_plate(), folder / name);
    const HybridMesh read = read_volume_file(folder / name, k_context);
    EXPECT_TRUE(read.periodic.empty());
    EXPECT_EQ(read.patches.size(), periodic_plate().patches.size()) << name;
  }
}

TEST(PeriodicMesh, UnmatchedSidesAreNotWrittenAsCyclic) {
  HybridMesh mesh = periodic_plate();
  const PeriodicMatch match = match_periodic(mesh, mesh.periodic[0].first, mesh.periodic[0].second, 1e-10);
  mesh.points[match.nodes[7][1]].y += 1e-6;
  const auto folder = test::scratch();
  EXPECT_THAT(test::error_of([&] { write(mesh, folder / "plate.foam"); }).info().problem, HasSubstr("no partner"));
}

}  // namespace
}  // namespace sterna::io
