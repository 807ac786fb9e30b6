// What independent programs say of meshes with actuator discs on walls.
#include <gtest/gtest.h>

#include "io/volume_file.h"
#include "tests/support/data.h"
#include "tests/support/process.h"
#include "tests/volmesh/driver/revolved_bodies.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

TEST(DiscFiles, OtherProgramsAcceptAFanBetweenHubAndDuct) {
  TriMesh wall = duct();
  append(wall, hub());
  VolumeMeshOptions options;
  options.envelope.layers = 8;
  options.envelope.first_height = 2e-3;
  options.farfield.farfield_radius = 15.0;
  options.discs = {{.name = "fan", .center = {-0.3, 0, 0}, .radius = 1.5}, {.name = "prop", .center = {-1.6, 0, 0}, .radius = 1.2}};
  const RunContext context({.threads = 2});
  const auto folder = test::scratch();
  io::write_volume_file(volume_mesh(wall, options, context).mesh, folder / "fan.sterna", context);
  const test::ProcessResult result =
      test::run_process(STERNA_SOURCE_DIR "/tools/accept_mesh", {"fan.sterna", "--sterna", test::sterna_program().string()}, folder);
  constexpr int k_not_installed = 77;
  STERNA_NEEDS((result.status == k_not_installed ? std::optional<int>() : std::optional<int>(result.status)), "the Debian packages openfoam and cgns-convert");
  EXPECT_EQ(result.status, 0) << result.output << result.errors;
}

}  // namespace
}  // namespace sterna::volmesh
