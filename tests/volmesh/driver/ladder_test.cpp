// The retry steps that change the layer, through the whole pipeline; helper programs that fail on purpose.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "geom/base/error.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/test_shapes.h"
#include "volmesh/tetra/engine_process.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using testing::HasSubstr;

/// A plate whose narrow sides are slivers, so that repair is necessary.
TriMesh thin_plate() {
  TriMesh plate = test::cube(4);
  for (Point& p : plate.points) p.z *= 5e-4;
  return plate;
}

class DriverLadder : public testing::Test {
 protected:
  /// Returns a helper folder in which TetGen crashes in its first `n` runs, and HXT always.
  std::string folder_that_fails(int n) {
    const std::filesystem::path folder = test::scratch();
    const std::string count = (folder / "count").string();
    std::ofstream(folder / "sterna-tet-tetgen") << "#!/bin/sh\necho x >> " << count << "\n[ $(wc -l < " << count << ") -gt " << n
                                                << " ] || kill -SEGV $$\nexec " << find_helper("sterna-tet-tetgen", {}) << "\n";
    std::ofstream(folder / "sterna-tet-hxt") << "#!/bin/sh\nkill -SEGV $$\n";
    for (const char* name : {"sterna-tet-tetgen", "sterna-tet-hxt"}) std::filesystem::permissions(folder / name, std::filesystem::perms::owner_all);
    return folder.string();
  }
  VolumeMeshResult mesh(const TriMesh& wall, TetraOptions tetrahedra) {
    MeshCase options;
    options.envelope.layers = 6;
    options.envelope.first_height = 1e-4;
    options.farfield.farfield_radius = 10.0;
    options.tetrahedra = std::move(tetrahedra);
    return volume_mesh(wall, options, RunContext({.threads = 2, .log = [this](LogLevel level, std::string_view text) {
                                                    if (level == LogLevel::warning) log_ += std::string(text) + "\n";
                                                  }}));
  }
  std::string log_;
};

TEST_F(DriverLadder, ARepairedLayerFollowsWhenAllElseFails) {
  const VolumeMeshResult result = mesh(thin_plate(), {.engine = "hxt", .boundary_splits = "never", .helper_folder = folder_that_fails(1)});
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_THAT(log_, HasSubstr("trying again with the layer lowered"));
  EXPECT_GE(result.tetra_failures.size(), 2u);
  EXPECT_TRUE(result.is_reproducible);
}

TEST_F(DriverLadder, RepairsCanBeForbiddenAndEnd) {
  test::expect_error(ErrorCode::tetra_engine_failed, "(HXT): the helper died of signal 11", [&] {
    (void)mesh(thin_plate(), {.engine = "hxt", .boundary_splits = "never", .repair_boundary = false, .helper_folder = folder_that_fails(1)});
  });
  EXPECT_THAT(log_, testing::Not(HasSubstr("trying again")));
  test::expect_error(ErrorCode::tetra_engine_failed, "(HXT): the helper died of signal 11",
                     [&] { (void)mesh(thin_plate(), {.engine = "hxt", .boundary_splits = "never", .helper_folder = folder_that_fails(100)}); });
  EXPECT_THAT(log_, HasSubstr("trying again"));
}

TEST_F(DriverLadder, SplitsComeBeforeRepairs) {
  const VolumeMeshResult result = mesh(test::cube(2), {.engine = "hxt", .helper_folder = folder_that_fails(1)});
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_THAT(log_, HasSubstr("trying TetGen with splits"));
  EXPECT_EQ(result.tetra_failures.size(), 2u);
}

}  // namespace
}  // namespace sterna::volmesh
