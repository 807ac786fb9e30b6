// A volume mesh given instead of a surface is refused in every format that holds both, unless its boundary is requested.
#include <gmock/gmock.h>

#include "io/file/format_table.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "tests/scripting/script_fixture.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class VolumeAsSurface : public ScriptFixture {
 protected:
  void SetUp() override {
    run("volume_mesh{ surface_mesh{ box{ {0,0,0}, {1,1,1} }, max_edge = 0.5 }, layers = 2, first_height = 0.01, farfield = sphere{ radius = 5 } }:write(" +
        out("mesh.su2") + ")");
    mesh_ = io::read_volume_file(folder_ / "mesh.su2", RunContext());
    n_cells_ = static_cast<std::uint64_t>(count_cells(mesh_).total());
  }
  HybridMesh mesh_;
  std::uint64_t n_cells_ = 0;
};

TEST_F(VolumeAsSurface, EveryReaderOfBothCountsTheCells) {
  int n = 0;
  for (const io::Format& format : io::formats()) {
    if (!format.read_surface || !format.read_volume || !format.write_volume) continue;
    const std::string extension(format.extensions.substr(0, format.extensions.find(' ')));
    SCOPED_TRACE(std::string(format.name) + " " + extension);
    const auto path = folder_ / ("volume_" + std::to_string(++n) + extension);
    io::write_volume_file(mesh_, path, RunContext(), format.name);
    const SurfaceSoup soup = io::read_surface_file(path, RunContext());
    EXPECT_EQ(soup.n_cells, n_cells_);
    EXPECT_FALSE(soup.triangles.empty());
    EXPECT_THAT(error("read_surface(" + out(path.filename().string()) + ")"), HasSubstr("it is a volume mesh of "));
    if (!format.write_surface) continue;
    const auto wall = folder_ / ("surface_" + std::to_string(n) + extension);
    io::write_surface_file(io::to_tri_mesh(soup), wall, RunContext(), format.name);
    EXPECT_EQ(io::read_surface_file(wall, RunContext()).n_cells, 0u);  // the same format holds surfaces, too
  }
  EXPECT_GE(n, 8);
}

TEST_F(VolumeAsSurface, BoundaryIsTakenOnRequest) {
  const std::string problem = error("volume_mesh{ read_surface(" + out("mesh.su2") + "), layers = 2, first_height = 0.01 }");
  EXPECT_THAT(problem, AllOf(HasSubstr("volume mesh of"), HasSubstr("farfield"), HasSubstr("convert"), HasSubstr("take_boundary")));
  EXPECT_THAT(error("union{ " + out("mesh.su2") + " }"), HasSubstr("it is a volume mesh"));
  EXPECT_THAT(error("inspect{ " + out("mesh.su2") + " }"), HasSubstr("it is a volume mesh"));
  EXPECT_THAT(error("half(" + out("mesh.su2") + ")"), HasSubstr("it is a volume mesh"));
  EXPECT_EQ(run("local s = read_surface{ " + out("mesh.su2") + ", take_boundary = true } print(s.triangles)"),
            std::to_string(mesh_.boundary_triangles.size() + 2 * mesh_.boundary_quads.size()) + "\n");
}

}  // namespace
}  // namespace sterna::scripting
