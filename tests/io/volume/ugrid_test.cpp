#include <limits>

#include "io/file/format_table.h"
#include "io/file/volume_file.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::io {
namespace {

using test::read;

TEST(UgridRead, Samples) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats";
  for (const std::string variant : {".lb8", ".b8", ".lb8l", ""}) {
    HybridMesh mesh = read(samples / ("pt" + variant + ".ugrid"));
    EXPECT_EQ(count_cells(mesh).total(), 2);
    EXPECT_EQ(mesh.patches.raw(), (std::vector<Patch>{{"wall", PatchKind::wall}, {"farfield", PatchKind::farfield}, {"side", PatchKind::symmetry}}));
    EXPECT_NEAR(test::volume_of(mesh), 2.0 / 3.0, 1e-15);
    EXPECT_NEAR(test::enclosed_volume(mesh), 2.0 / 3.0, 1e-15);
    mesh = read(samples / ("mix4" + variant + ".ugrid"));
    EXPECT_EQ(mesh.pyramids.size(), 1u);
    EXPECT_NEAR(test::volume_of(mesh), 1.983333, 1e-6);  // value of docs/method/formats.md, "Sample meshes", to its digits
    EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-14);
  }
  const HybridMesh sphere = read(samples / "sphere_mixed.1.lb8.ugrid");
  EXPECT_EQ(sphere.prisms.size(), 3024u);
  EXPECT_EQ(sphere.tetrahedra.size(), 9072u);
  EXPECT_NEAR(test::enclosed_volume(sphere), test::volume_of(sphere), 1e-12 * test::volume_of(sphere));  // rounding of 1e4 terms
}

TEST(UgridRead, NeverCrashesOnCutFiles) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string bytes = test::bytes_of(test::shared_data() / "formats" / "mix4.lb8.ugrid");
  for (std::size_t n = 1; n < bytes.size(); n += 5)
    test::expect_error(ErrorCode::file_malformed, "byte", [&] { read(test::write_text("mesh.lb8.ugrid", bytes.substr(0, n))); });
}

using test::write;

/// Returns the mesh with the sample's patches in the order of their numbers; reading orders patches by appearance.
HybridMesh with_patches_of_mapbc(HybridMesh mesh, const std::vector<std::string>& names) {
  Column<PatchId, Patch> sorted;
  std::vector<PatchId> location(mesh.patches.size());
  for (const std::string& name : names)
    for (const PatchId patch : mesh.patches.ids())
      if (mesh.patches[patch].name == name) location[patch.index()] = sorted.push_back(mesh.patches[patch]);
  for (auto& face : mesh.boundary_triangles) face.patch = location[face.patch.index()];
  for (auto& face : mesh.boundary_quads) face.patch = location[face.patch.index()];
  mesh.patches = sorted;
  return mesh;
}

TEST(UgridWrite, SamplesByteForByte) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats", folder = test::scratch();
  const std::pair<std::string, std::vector<std::string>> bodies[] = {{"pt", {"wall", "side", "farfield"}}, {"mix4", {"wall", "symmetry", "farfield"}}};
  for (const auto& [body, names] : bodies) {
    for (const std::string variant : {".lb8", ".b8", ".lb8l", ""}) {
      const std::string file = body + variant + ".ugrid";
      SCOPED_TRACE(file);
      write(with_patches_of_mapbc(read(samples / file), names), folder / file);
      EXPECT_EQ(test::bytes_of(folder / file), test::bytes_of(samples / file));
    }
  }
  EXPECT_EQ(test::bytes_of(folder / "pt.mapbc"), "3\n1 4000 wall\n2 6662 side\n3 5000 farfield\n");
}

TEST(Ugrid, RoundTripOfMixedMeshInEveryVariant) {
  const auto folder = test::scratch();
  for (const HybridMesh& mesh : {test::mixed_mesh(), test::hexahedron_with_roof()}) {
    const HybridMesh expected = explicit_cells(mesh);
    for (const std::string variant : {".lb8", ".b8", ".lb8l", ".b8l", ""}) {
      const auto file = folder / ("mesh" + variant + ".ugrid");
      SCOPED_TRACE(file.string());
      write(mesh, file);
      const HybridMesh back = read(file);
      EXPECT_EQ(back.points, expected.points);
      EXPECT_EQ(back.prisms, expected.prisms);
      EXPECT_EQ(back.pyramids, expected.pyramids);
      EXPECT_EQ(back.hexahedra, expected.hexahedra);
      EXPECT_EQ(back.tetrahedra, expected.tetrahedra);
      EXPECT_NEAR(test::enclosed_volume(back), test::volume_of(mesh), 1e-12 * test::volume_of(mesh));  // rounding of sums
      for (std::size_t i = 0; i < back.boundary_triangles.size(); ++i)
        EXPECT_EQ(back.patches[back.boundary_triangles[i].patch], mesh.patches[mesh.boundary_triangles[i].patch]);
      for (std::size_t i = 0; i < back.boundary_quads.size(); ++i)
        EXPECT_EQ(back.patches[back.boundary_quads[i].patch], mesh.patches[mesh.boundary_quads[i].patch]);
      const std::string bytes = test::bytes_of(file);
      write(mesh, file, 1);
      EXPECT_EQ(test::bytes_of(file), bytes);
    }
  }
  write(test::mixed_mesh(), folder / "single.lb4.ugrid");
  EXPECT_NEAR(test::volume_of(read(folder / "single.lb4.ugrid")), test::volume_of(test::mixed_mesh()), 1e-6);  // single precision of lengths near 1
}

TEST(UgridWrite, AnIndependentReaderFindsTheSame) {
  const HybridMesh mesh = test::mixed_mesh();
  for (const std::string name : {"mesh.lb8.ugrid", "mesh.b8.ugrid", "mesh.ugrid"}) {
    const auto file = test::scratch() / name;
    write(mesh, file);
    const auto report = test::read_independently("meshio", file);
    STERNA_NEEDS(report, "the Python module of the independent reader");
    EXPECT_EQ(report->number("points"), static_cast<double>(mesh.points.size()));
    EXPECT_EQ(report->number("cells.wedge"), static_cast<double>(count_cells(mesh).prisms));
    EXPECT_EQ(report->number("cells.tetra"), static_cast<double>(count_cells(mesh).tetrahedra));
    const double tolerance = name == "mesh.ugrid" ? 1e-8 : 1e-15;                // for a volume of 0.0087; meshio reads the text in single precision
    EXPECT_NEAR(report->number("enclosed"), -test::volume_of(mesh), tolerance);  // inwards, as in NASA's tools
    EXPECT_NEAR(report->number("volume.wedge") + report->number("volume.pyramid") + report->number("volume.tetra"), test::volume_of(mesh), tolerance);
  }
}

TEST(UgridWrite, RefusesWhatItCannotHold) {
  HybridMesh mesh = test::mixed_mesh();
  test::expect_error(ErrorCode::unsupported_format, "Fortran records", [&] { write(mesh, test::scratch() / "mesh.r8.ugrid"); });
  mesh.points[NodeId(4)].y = std::numeric_limits<double>::infinity();
  test::expect_error(ErrorCode::mesh_invalid, "node 4 are not finite", [&] { write(mesh, test::scratch() / "mesh.lb8.ugrid"); });
  mesh.layers.n_layers = std::numeric_limits<int>::max();
  test::expect_error(ErrorCode::overflow, "64-bit: .lb8l.ugrid", [&] { write(mesh, test::scratch() / "mesh.lb8.ugrid"); });
  EXPECT_TRUE(test::files_in(test::scratch()).empty());
}

TEST(FormatTable, NamesAreFoundByTheirEnd) {
  EXPECT_EQ(format_of("dir.vtu/Wing.SU2").name, "SU2");
  EXPECT_EQ(format_of("wing.v2.su2.gz").name, "SU2");
  EXPECT_EQ(format_of("wing.LB8.ugrid").name, "UGRID");
  test::expect_error(ErrorCode::unsupported_format, ".su2", [] { format_of("wing"); });
  test::expect_error(ErrorCode::unsupported_format, "UGRID (.lb8.ugrid", [] { write_volume_file({}, "wing.stl", RunContext({.threads = 1})); });
  test::expect_error(ErrorCode::unsupported_format, "gzip-compressed files cannot be written",
                     [] { write_volume_file({}, "wing.su2.gz", RunContext({.threads = 1})); });
  test::expect_error(ErrorCode::unsupported_format, "volume meshes are read from", [] { read_volume_file("wing.stl", RunContext({.threads = 1})); });
}

}  // namespace
}  // namespace sterna::io
