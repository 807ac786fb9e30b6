#include <gmock/gmock.h>

#include <cstring>
#include <fstream>

#include "io/file/surface_file.h"
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

TEST(Fluent, RoundTripOfMixedMeshes) {
  const auto path = test::scratch() / "mesh.fluent.msh";
  for (const HybridMesh& mesh : {test::six_patch_mesh("_\xC3\xBC"
                                                      "ber"),
                                 test::hexahedra_block(3), test::hexahedron_with_roof(), test::sphere_shell(4, {.n_layers = 5, .collapsed = {3, 50, 51}})})
    test::expect_round_trip(mesh, path, CellOrder::rotated);
}

TEST(Fluent, KindsThatAreLostAreTold) {
  const auto path = test::scratch() / "mesh.fluent.msh";
  HybridMesh mesh = test::hexahedron_with_roof();
  mesh.patches.raw() = {{"tunnel", PatchKind::slip}, {"slippery", PatchKind::wall}};
  EXPECT_THAT(
      test::warnings_of_writing(mesh, path),
      testing::ElementsAre("patch \"tunnel\" (slip) is written as a Fluent zone of type wall, which is read as wall: set its shear stress to zero in Fluent",
                           "patch \"slippery\" (wall) is written as a Fluent zone of type wall, which is read as slip"));
  mesh.patches.raw() = {{"slip_tunnel", PatchKind::slip}, {"inner", PatchKind::interface}};
  EXPECT_THAT(test::warnings_of_writing(mesh, path), testing::IsEmpty());
  EXPECT_EQ(read(path).patches.raw(), mesh.patches.raw());
}

TEST(Fluent, Samples) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats", folder = test::scratch();
  for (const std::string body : {"pt", "mix4"}) {
    const HybridMesh mesh = read(samples / (body + ".fluent.msh"));
    EXPECT_EQ(count_cells(mesh).total(), body == "pt" ? 2 : 4);
    EXPECT_NEAR(test::volume_of(mesh), body == "pt" ? 2.0 / 3.0 : 1.983333, 1e-6);  // values of docs/method/formats.md, "Sample meshes", to their digits
    EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-14);
    EXPECT_EQ(mesh.patches.raw(),
              (std::vector<Patch>{{"wall", PatchKind::wall}, {body == "pt" ? "side" : "symmetry", PatchKind::symmetry}, {"farfield", PatchKind::farfield}}));
    std::filesystem::copy_file(samples / (body + ".fluent.msh"), folder / (body + ".msh"));
    EXPECT_EQ(read(folder / (body + ".msh")).points, mesh.points);  // distinguished from Gmsh's format by content
    const SurfaceSoup wall = read_surface_file(folder / (body + ".msh"), RunContext({.threads = 1}));
    EXPECT_EQ(wall.triangles.size(), body == "pt" ? 1u : 2u);
    EXPECT_EQ(wall.patch_names, std::vector<std::string>{"wall"});
  }
}

TEST(Fluent, OpenFoamReadsTheSame) {
  const auto folder = test::scratch();
  const HybridMesh mesh = test::six_patch_mesh();
  write(mesh, folder / "mesh.fluent.msh");
  test::make_foam_case(folder / "case.foam");
  const auto converted = test::run_openfoam("fluent3DMeshToFoam", {"-case", "case.foam", "mesh.fluent.msh"}, folder);
  STERNA_NEEDS(converted, "the Debian package openfoam");
  const auto checked = test::run_openfoam("checkMesh", {"-case", "case.foam", "-allTopology"}, folder);
  STERNA_NEEDS(checked, "the Debian package openfoam");
  EXPECT_NE(checked->find("Mesh OK."), std::string::npos) << *converted << *checked;
  const HybridMesh back = read(folder / "case.foam");
  EXPECT_EQ(count_cells(back).prisms, count_cells(mesh).prisms);
  EXPECT_EQ(count_cells(back).pyramids, count_cells(mesh).pyramids);
  EXPECT_EQ(count_cells(back).tetrahedra, count_cells(mesh).tetrahedra);
  EXPECT_NEAR(test::volume_of(back), test::volume_of(mesh), 1e-12 * test::volume_of(mesh));
  std::vector<std::string> names;
  for (const Patch& patch : back.patches) names.push_back(patch.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("plate", "farfield", "west", "east", "symmetry", "slip_north"));
}

template <class T>
std::string bytes(std::initializer_list<T> values) {
  std::string result(values.size() * sizeof(T), '\0');
  std::memcpy(result.data(), values.begin(), result.size());
  return result;
}

/// Returns a tetrahedron with binary nodes and faces, as written by Fluent.
std::string binary_tet(bool is_double) {
  const std::string s = is_double ? "30" : "20";
  const std::string nodes = is_double ? bytes<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) : bytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  const auto faces = bytes<std::int32_t>({1, 2, 3, 1, 0, 1, 4, 2, 1, 0, 2, 4, 3, 1, 0, 3, 4, 1, 1, 0});
  return "(0 \"a (comment)\")\n(2 3)\n(10 (0 1 4 0 3))\n(12 (0 1 1 0))\n(13 (0 1 4 0))\n(37 (\"(unbalanced\" (a b)))\n(" + s + "10 (1 1 4 1 3)\n(" + nodes +
         ")\nEnd of Binary Section   " + s + "10)\n(12 (2 1 1 1 2))\n(20" + "13 (5 1 4 3 3)(" + faces +
         ")\nEnd of Binary Section   2013)\n(39 (5 wall hull)())\n";
}

TEST(Fluent, BinarySectionsAreRead) {
  for (const bool is_double : {false, true}) {
    const HybridMesh mesh = read(test::write_text("tet.msh", binary_tet(is_double)));
    EXPECT_EQ(mesh.tetrahedra.size(), 1u);
    EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1.0 / 6.0);
    EXPECT_DOUBLE_EQ(test::enclosed_volume(mesh), 1.0 / 6.0);
    EXPECT_EQ(mesh.patches[PatchId(0)], (Patch{"hull", PatchKind::wall}));
  }
}

TEST(Fluent, HostileFiles) {
  const auto path = test::scratch() / "mesh.fluent.msh";
  write(test::hexahedron_with_roof(), path);
  const std::string text = test::bytes_of(path);
  const auto wrong = [&](const std::string& from, const std::string& to, const std::string& message, ErrorCode code = ErrorCode::file_malformed) {
    SCOPED_TRACE(to);
    std::string changed = text;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos) << from << "\n" << text;
    std::ofstream(path, std::ios::binary) << changed.replace(at, from.size(), to);
    test::expect_error(code, message, [&] { read(path); });
  };
  wrong("(2 3)", "(2 2)", "2 dimensions", ErrorCode::unsupported_format);
  wrong("(10 (1 1 9 1 3)", "(10 (1 1 7ffffff0 1 3)", "more than the");
  wrong("(10 (1 1 9 1 3)", "(10 (1 1 9999999999999 1 3)", "ascending numbers below");
  wrong("(10 (1 1 9 1 3)", "(10 (1 1 a 1 3)", "expected a coordinate");
  wrong("(10 (1 1 9 1 3)", "(10 (1 1 8 1 3)", "expected \")\" behind a body");
  wrong("(10 (1 1 9 1 3)", "(10 (1 2 a 1 3)", "expected 1");
  wrong("0.5 0.5 1.5", "0.5 nan 1.5", "line");
  wrong("(12 (2 1 2 1 0)", "(12 (2 1 fffffff 1 0)", "too many");
  wrong("(12 (2 1 2 1 0)", "(59 (2 1 2 1 0)", "hanging nodes", ErrorCode::unsupported_format);
  wrong("2 0\n))", "3 0\n))", "there are 2");
  wrong("2 0\n))", "1 0\n))", "cell 0: its 6 faces do not enclose");
  wrong("(13 (3 1 1 2 0)(\n4 ", "(13 (3 1 1 2 0)(\n5 ", "expected");
  wrong("(13 (3 1 1 2 0)(\n4 ", "(13 (3 1 1 2 0)(\n4f ", "number of nodes of a face");
  wrong(" 2\n))\n(13 (4", " 0\n))\n(13 (4", "interior face with one cell");
  wrong("(45 (2", "(45 2", "\"(\" of a zone");
  std::ofstream(path, std::ios::binary) << text;
  test::expect_no_crash_on_damage(path, 5);
  std::ofstream(path, std::ios::binary) << binary_tet(true);
  test::expect_no_crash_on_damage(path, 3);
}

}  // namespace
}  // namespace sterna::io
