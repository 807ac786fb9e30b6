#include <gmock/gmock.h>

#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "tests/io/volume/round_trip.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/process.h"

namespace sterna::io {
namespace {

using test::CellOrder;
using test::Kinds;

using test::read;
using test::write;

TEST(MshVolume, RoundTripOfMixedMeshes) {
  const auto folder = test::scratch();
  for (const std::string name : {"text.msh", "binary.bin.msh"}) {
    SCOPED_TRACE(name);
    for (const HybridMesh& mesh : {test::six_patch_mesh(" \xC3\xBC"
                                                        "ber"),
                                   test::hexahedra_block(3), test::hexahedron_with_roof()})
      test::expect_round_trip(mesh, folder / name, CellOrder::same, Kinds::by_name);
  }
}

TEST(MshVolume, Samples) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats", folder = test::scratch();
  for (const std::string name : {"pt.v22", "pt.v22bin", "pt.v41", "pt.v41bin", "mix4.v22", "mix4.v22bin", "mix4.v41"}) {
    SCOPED_TRACE(name);
    const HybridMesh mesh = read(samples / (name + ".msh"));
    const bool is_pt = name.starts_with("pt");
    EXPECT_EQ(count_cells(mesh).total(), is_pt ? 2 : 4);
    EXPECT_NEAR(test::volume_of(mesh), is_pt ? 2.0 / 3.0 : 1.983333, 1e-6);  // values of docs/method/formats.md, "Sample meshes", to their digits
    EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-14);
    EXPECT_EQ(mesh.patches.size(), 3u);
    EXPECT_THAT(mesh.patches.raw(), testing::Contains(Patch{"farfield", PatchKind::farfield}));
  }
  const HybridMesh mesh = read(samples / "mix4.v41.msh");
  EXPECT_EQ(mesh.pyramids.size(), 1u);
  EXPECT_EQ(mesh.hexahedra.size(), 1u);
}

TEST(MshVolume, IndependentReadersAgree) {
  const HybridMesh mesh = test::six_patch_mesh();
  const auto folder = test::scratch();
  for (const std::string name : {"mesh.msh", "mesh.bin.msh"}) {
    write(mesh, folder / name);
    const auto report = test::read_independently("meshio", folder / name);
    STERNA_NEEDS(report, "the Python module of the independent reader");
    test::expect_same_mesh(*report, mesh);
    const auto of_gmsh = test::read_independently("gmsh", folder / name);
    STERNA_NEEDS(of_gmsh, "the Python module of the independent reader");
    test::expect_same_mesh(*of_gmsh, mesh);
  }
}

TEST(MshVolume, DamagedFilesAndFullDisks) {
  const auto folder = test::scratch();
  for (const std::string name : {"mesh.msh", "mesh.bin.msh"}) {
    write(test::hexahedron_with_roof(), folder / name);
    test::expect_no_crash_on_damage(folder / name, 11);
    const std::string bytes = test::bytes_of(folder / name);
    {
      const test::FullDisk full(2000);
      test::expect_error(ErrorCode::write_failed, "", [&] { write(test::six_patch_mesh(), folder / name); });
    }
    EXPECT_EQ(test::bytes_of(folder / name), bytes);
  }
  EXPECT_EQ(test::files_in(folder).size(), 2u);
}

}  // namespace
}  // namespace sterna::io
