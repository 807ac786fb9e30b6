#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "tests/io/volume/round_trip.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/test_shapes.h"

namespace sterna::io {
namespace {

using test::CellOrder;

using test::read;
using test::write;

const std::vector<std::string> k_files = {"mesh.mesh", "mesh.meshb", "mesh.v2.meshb", "mesh.v3.meshb", "mesh.v4.meshb"};

TEST(Medit, RoundTripOfMixedMeshes) {
  const auto folder = test::scratch();
  for (const std::string& name : k_files) {
    SCOPED_TRACE(name);
    for (const HybridMesh& mesh : {test::six_patch_mesh(" \xC3\xBC"
                                                        "ber"),
                                   test::hexahedra_block(3), test::hexahedron_with_roof()})
      test::expect_round_trip(mesh, folder / name, CellOrder::same);
  }
  EXPECT_EQ(test::bytes_of(folder / "mesh.meshb"), test::bytes_of(folder / "mesh.v2.meshb"));
  EXPECT_EQ(test::bytes_of(folder / "mesh.names"), "# patches: number kind name\n1 wall box\n2 wall roof\n");
}

TEST(Medit, Samples) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats";
  for (const std::string body : {"pt", "mix4"}) {
    for (const std::string variant : {".mesh", ".v2.meshb", ".v3.meshb", ".v4.meshb"}) {
      SCOPED_TRACE(body + variant);
      const HybridMesh mesh = read(samples / (body + variant));
      EXPECT_EQ(count_cells(mesh).total(), body == "pt" ? 2 : 4);
      EXPECT_NEAR(test::volume_of(mesh), body == "pt" ? 2.0 / 3.0 : 1.983333, 1e-6);  // values of docs/method/formats.md, "Sample meshes", to their digits
      EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-14);
      EXPECT_EQ(mesh.patches.size(), 3u);
      const SurfaceSoup soup = read_surface_file(samples / (body + variant), RunContext({.threads = 1}));
      EXPECT_EQ(soup.triangles.size(), mesh.boundary_triangles.size() + 2 * mesh.boundary_quads.size());
      EXPECT_EQ(soup.patch_names.size(), 3u);
    }
  }
  const HybridMesh cube = read(samples / "cube-sphere.meshb");
  EXPECT_GT(cube.tetrahedra.size(), 1000u);
  EXPECT_NEAR(test::enclosed_volume(cube), test::volume_of(cube), 1e-10 * test::volume_of(cube));
  const HybridMesh sphere = read(samples / "sphere_mixed.1.meshb");
  EXPECT_EQ(sphere.prisms.size(), 3024u);  // the same as its counterpart in UGRID
  EXPECT_EQ(sphere.tetrahedra.size(), 9072u);
  EXPECT_NEAR(test::enclosed_volume(sphere), test::volume_of(sphere), 1e-12 * test::volume_of(sphere));
}

TEST(Medit, Variants) {
  const std::string tet =
      "MeshVersionFormatted\n1\n# a comment\nDimension\n3\nTetrahedra 1\n1 3 2 4 7\nCorners\n2\n1\n4\nVertices 4\n0 0 0 0\n1. 0 0 0\n0 1 0 0\n0 0 +1e0 "
      "0\nNormals 1\n0 -0.5 1e-3\nTriangles 1\n1 2 3 -5\nEnd";
  const HybridMesh mesh = read(test::write_text("tet.mesh", tet));
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1.0 / 6.0);
  ASSERT_EQ(mesh.boundary_triangles.size(), 1u);
  EXPECT_EQ(mesh.boundary_triangles[0].nodes, (std::array{NodeId(0), NodeId(2), NodeId(1)}));
  EXPECT_EQ(mesh.patches[PatchId(0)].name, "patch_-5");
}

/// Reverses the bytes of the numbers of a version 2 file without integer coordinates; handles only sections of known layout.
std::string big_endian(const std::string& little) {
  std::string bytes = little;
  const auto turn = [&](std::size_t at, std::size_t n) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(at + n));
  };
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, little.data() + at, 4);
    return value;
  };
  turn(0, 4);
  turn(4, 4);
  for (std::size_t at = 8; at < little.size();) {
    const std::uint32_t code = number(at), next = number(at + 4);
    turn(at, 4);
    turn(at + 4, 4);
    const std::size_t end = next == 0 ? little.size() : next;
    at += 8;
    if (code == 4) {
      turn(at, 4);
      for (at += 4; at < end; at += 28) {
        for (std::size_t k = 0; k < 24; k += 8) turn(at + k, 8);
        turn(at + 24, 4);
      }
    }
    for (; at < end; at += 4) turn(at, 4);
  }
  return bytes;
}

TEST(Medit, BigEndianFilesAreRead) {
  const auto path = test::scratch() / "mesh.meshb";
  const HybridMesh mesh = test::six_patch_mesh();
  write(mesh, path);
  const std::string bytes = big_endian(test::bytes_of(path));
  std::ofstream(path, std::ios::binary) << bytes;
  test::expect_same_after_reading(read(path), mesh, CellOrder::same);
}

TEST(Medit, IndependentReadersAgree) {
  const HybridMesh mesh = test::six_patch_mesh();
  const auto folder = test::scratch();
  for (const std::string& name : k_files) {
    SCOPED_TRACE(name);
    write(mesh, folder / name);
    const auto report = test::read_independently("meshio", folder / name);
    STERNA_NEEDS(report, "the Python module of the independent reader");
    test::expect_same_mesh(*report, mesh);
  }
}

TEST(Medit, SurfacesThereAndBack) {
  const auto folder = test::scratch();
  TriMesh cube = test::cube(3);
  cube.patches.push_back({"lid", PatchKind::slip});
  cube.triangle_patch[TriangleId(4)] = PatchId(1);
  for (const std::string name : {"cube.mesh", "cube.meshb", "cube.v4.meshb"}) {
    write_surface_file(cube, folder / name, RunContext({.threads = 2}));
    const SurfaceSoup soup = read_surface_file(folder / name, RunContext({.threads = 2}));
    ASSERT_EQ(soup.triangles.size(), cube.n_triangles());
    EXPECT_TRUE(soup.has_names);
    for (const TriangleId t : cube.triangles.ids()) {
      EXPECT_EQ(soup.patch_names[soup.patch[t.index()]], cube.patches[cube.triangle_patch[t]].name);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(soup.points[soup.triangles[t.index()][k]], cube.points[cube.triangles[t][k]]);
    }
  }
}

TEST(Medit, HostileFiles) {
  const std::string text =
      "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\nTriangles\n1\n1 3 2 1\nTetrahedra\n1\n1 2 3 4 1\nEnd\n";
  const auto wrong = [&](const std::string& from, const std::string& to, const std::string& message, ErrorCode code = ErrorCode::file_malformed) {
    SCOPED_TRACE(to);
    std::string changed = text;
    const std::size_t at = changed.find(from);
    ASSERT_NE(at, std::string::npos);
    test::expect_error(code, message, [&] { read(test::write_text("tet.mesh", changed.replace(at, from.size(), to))); });
  };
  wrong("Formatted 2", "Formatted 7", "a version from 1 to 4");
  wrong("Dimension 3", "Dimension 2", "2 dimensions", ErrorCode::unsupported_format);
  wrong("Vertices\n4", "Vertices\n400000000", "400000000");
  wrong("Vertices\n4", "Vertices\n5", "expected a coordinate");
  wrong("Vertices\n4", "Vertices\n3", "expected a keyword");
  wrong("0 0 1 0", "0 0 inf 0", "line 8");
  wrong("1 3 2 1", "1 3 5 1", "line 11: triangle 1 has the vertex 5, there are 4");
  wrong("1 3 2 1", "0 3 2 1", "found 0 as a vertex");
  wrong("1 3 2 1", "1 3 99999999999 1", "found 99999999999 as a vertex");
  wrong("Tetrahedra", "TetrahedraP2", "higher order", ErrorCode::unsupported_format);
  test::expect_error(ErrorCode::file_malformed, "found no Vertices", [] { read(test::write_text("tet.mesh", "MeshVersionFormatted 2\nDimension 3\nEnd\n")); });
  const auto folder = test::scratch();
  for (const std::string name : {"a.mesh", "a.v2.meshb", "a.v4.meshb"}) {
    write(test::hexahedron_with_roof(), folder / name);
    test::expect_no_crash_on_damage(folder / name, 7);
  }
  std::ofstream(folder / "a.names") << "1 wal box\n";
  test::expect_error(ErrorCode::file_malformed, "found \"wal\", expected wall, slip", [&] { read(folder / "a.mesh"); });
}

TEST(Medit, FullDiskLeavesTheOldFiles) {
  const auto folder = test::scratch();
  write(test::hexahedron_with_roof(), folder / "mesh.meshb");
  const std::string bytes = test::all_bytes(folder);
  {
    const test::FullDisk full(2000);
    test::expect_error(ErrorCode::write_failed, "", [&] { write(test::six_patch_mesh(), folder / "mesh.meshb"); });
  }
  EXPECT_EQ(test::all_bytes(folder), bytes);
}

}  // namespace
}  // namespace sterna::io
