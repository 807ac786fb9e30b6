// Half meshes whose layers end on a plane with quads of patches of every kind: results of independent programs that read the written files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/file/volume_file.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/half_shapes.h"
#include "tests/support/openfoam_tools.h"
#include "tests/support/process.h"

namespace sterna::io {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Returns a mesh with seven patches of seven kinds. Five are in the plane, each with quads, and with triangles beside collapsed growth lines or of tetrahedra.
HybridMesh half_mesh() { return test::half_shell_of_all_kinds(6, {.shell = {.n_layers = 4}, .has_collapsed_border = true}); }

using test::write;

TEST(HalfMesh, HasAllQuadAndTriangleKindsInPlane) {
  const HybridMesh mesh = half_mesh();
  std::vector<int> n_quads(mesh.patches.size()), n_triangles(mesh.patches.size());
  for (const BoundaryQuad& face : mesh.boundary_quads) ++n_quads[face.patch.index()];
  for (const BoundaryTriangle& face : mesh.boundary_triangles) ++n_triangles[face.patch.index()];
  ASSERT_EQ(mesh.patches.size(), 7u);
  for (const PatchId patch : mesh.patches.ids()) {
    const PatchKind kind = mesh.patches[patch].kind;
    EXPECT_GT(n_triangles[patch.index()], 0) << mesh.patches[patch].name;
    EXPECT_EQ(n_quads[patch.index()] > 0, kind != PatchKind::wall && kind != PatchKind::farfield) << mesh.patches[patch].name;
  }
  EXPECT_GT(count_cells(mesh).pyramids, 0);
  EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-12 * test::volume_of(mesh));  // all faces outwards; rounding of sums
}

/// meshio, VTK and gmsh find the same numbers of quads and triangles by patch, volumes by kind of cell, and orientation.
TEST(HalfMesh, IndependentReadersFindTheSame) {
  const auto folder = test::scratch();
  const HybridMesh mesh = half_mesh();
  for (const auto& [reader, name] : std::vector<std::pair<std::string, std::string>>{{"meshio", "half.su2"},
                                                                                     {"meshio", "half.msh"},
                                                                                     {"meshio", "half.mesh"},
                                                                                     {"meshio", "half.meshb"},
                                                                                     {"gmsh", "half.msh"},
                                                                                     {"vtk", "half.vtu"},
                                                                                     {"vtk", "half.vtkhdf"},
                                                                                     {"vtk-cgns", "half.cgns"}}) {
    SCOPED_TRACE(reader + " " + name);
    write(mesh, folder / name);
    const auto report = test::read_independently(reader, folder / name);
    STERNA_NEEDS(report, "the Python module of the independent reader");
    test::expect_same_mesh(*report, mesh);
  }
}

TEST(HalfMesh, CgnscheckFindsNothingAndEveryCondition) {
  const auto file = test::scratch() / "half.cgns";
  write(half_mesh(), file);
  const auto output = test::output_of_tool("cgnscheck", {"-V", file.string()});
  STERNA_NEEDS(output, "cgnscheck of the package cgns-convert");
  EXPECT_THAT(*output, testing::AllOf(HasSubstr("checking complete"), Not(HasSubstr("WARNING")), Not(HasSubstr("ERROR"))));
  for (const char* const condition : {"BCWallViscous", "BCWallInviscid", "BCSymmetryPlane", "BCInflow", "BCOutflow", "BCFarfield", "UserDefined"})
    EXPECT_THAT(*output, HasSubstr(condition));
}

TEST(HalfMesh, TauAndFun3dGetTheirConditions) {
  const auto folder = test::scratch();
  write(half_mesh(), folder / "half.taumesh");
  const std::string mapping = test::bytes_of(folder / "half.bmap");
  for (const char* const condition : {"viscous wall", "euler wall", "symmetry plane", "engine exhaust", "engine inflow", "farfield"})
    EXPECT_THAT(mapping, HasSubstr(condition));
  write(half_mesh(), folder / "half.lb8.ugrid");
  const std::string conditions = test::bytes_of(folder / "half.mapbc");
  for (const char* const condition : {" 4000 sphere", " 5000 farfield", " 6662 symmetry", " 3000 slip_wall", " 7011 inflow", " 7012 outflow", " 3000 disc"})
    EXPECT_THAT(conditions, HasSubstr(condition));
}

TEST(HalfMesh, CheckMeshFindsNothing) {
  const auto folder = test::scratch();
  const HybridMesh mesh = half_mesh();
  for (const std::string name : {"text.foam", "binary.bin.foam"}) {
    test::make_foam_case(folder / name);
    write(mesh, folder / name);
    const auto output = test::run_openfoam("checkMesh", {"-case", name, "-allTopology", "-allGeometry"}, folder);
    STERNA_NEEDS(output, "the Debian package openfoam");
    test::expect_clean(*output, {"small determinant", "non-orthogonal", "interpolation weight", "volume ratio", "skewness", "Concave", "face tets"});
    EXPECT_EQ(test::number_after(*output, "prisms:"), static_cast<double>(count_cells(mesh).prisms));
  }
  const std::string boundary = test::bytes_of(folder / "text.foam" / "constant" / "polyMesh" / "boundary");
  for (const char* const line : {"type wall;", "type symmetryPlane;", "inGroups 1(slip)", "inGroups 1(inflow)", "inGroups 1(outflow)", "inGroups 1(interface)"})
    EXPECT_THAT(boundary, HasSubstr(line));
}

/// checkMesh, a potential flow along the plane, and cgnscheck accept halves with planes of one kind and of all kinds.
TEST(HalfMesh, OtherProgramsAcceptIt) {
  const auto folder = test::scratch();
  write(half_mesh(), folder / "all.sterna");
  write(test::half_sphere_shell(6, {.shell = {.n_layers = 4}}), folder / "half.sterna");
  for (const std::string name : {"all.sterna", "half.sterna"}) {
    const test::ProcessResult result =
        test::run_process((test::source_folder() / "tools/accept_mesh").string(), {name, "--sterna", test::sterna_program().string()}, folder);
    constexpr int k_not_installed = 77;
    STERNA_NEEDS((result.status == k_not_installed ? std::optional<int>() : std::optional<int>(result.status)),
                 "the Debian packages openfoam and cgns-convert");
    EXPECT_EQ(result.status, 0) << result.output << result.errors;
  }
}

}  // namespace
}  // namespace sterna::io
