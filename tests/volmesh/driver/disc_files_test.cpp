// Actuator discs on walls of real surfaces, and the results of independent programs for such meshes.
#include <gtest/gtest.h>

#include "geom/math/measures.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/process.h"
#include "tests/volmesh/driver/revolved_bodies.h"
#include "volmesh/domain/disc_baffles.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

/// Area of one side, m^2.
double area_of(const HybridMesh& mesh, const std::string& name) {
  double sum = 0.0;
  for (const auto& t : mesh.boundary_triangles)
    if (mesh.patches[t.patch].name == name) sum += triangle_area(mesh.points[t.nodes[0]], mesh.points[t.nodes[1]], mesh.points[t.nodes[2]]);
  for (const auto& q : mesh.boundary_quads) {
    if (mesh.patches[q.patch].name != name) continue;
    sum += triangle_area(mesh.points[q.nodes[0]], mesh.points[q.nodes[1]], mesh.points[q.nodes[2]]) +
           triangle_area(mesh.points[q.nodes[0]], mesh.points[q.nodes[2]], mesh.points[q.nodes[3]]);
  }
  return sum;
}

TEST(DiscFiles, FanInDuctAndPropellerOnNose) {
  STERNA_NEEDS_SHARED_DATA();
  struct Case {
    const char* file;
    ActuatorDisc disc;
    double first_height;  ///< m
    double area,
        tolerance;  ///< m^2; expected area: the circle inside the duct, whose radius is 0.4 to 0.402 m there, or the disc without the nose, which is 0.2 to
                    ///< 0.45 m thick
  };
  const RunContext context({.threads = 2});
  for (const Case& c : {Case{"flowpanel_duct_duct_remeshed_refined.msh", {.name = "fan", .center = {0.0, 0.0, 0.0}, .radius = 0.5}, 1e-4, 0.505, 0.003},
                        Case{"flowpanel_cessna_cessna.msh", {.name = "prop", .center = {-1.0, 0.0, 0.0}, .radius = 3.0}, 1e-3, 28.0, 0.2}}) {
    SCOPED_TRACE(c.file);
    const TriMesh wall = surfmesh::stitch_surface({io::read_surface_file(test::shared_data() / "surfaces" / "clean" / c.file, context)}, {}, context).mesh;
    MeshCase options;
    options.envelope.layers = 6;  // few layers and a near farfield, since only the disc matters here
    options.envelope.first_height = c.first_height;
    options.farfield.farfield_radius = 5.0 * body_length(wall);
    options.discs = {c.disc};
    const VolumeMeshResult result = volume_mesh(wall, options, context);
    EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
    EXPECT_NEAR(area_of(result.mesh, c.disc.name), c.area, c.tolerance);
    EXPECT_NEAR(area_of(result.mesh, c.disc.name), area_of(result.mesh, back_name(c.disc)), 1e-12 * c.area);
    EXPECT_FALSE(result.mesh.boundary_quads.empty());
  }
}

TEST(DiscFiles, OtherProgramsAcceptFanBetweenHubAndDuct) {
  TriMesh wall = duct();
  append(wall, hub());
  MeshCase options;
  options.envelope.layers = 8;
  options.envelope.first_height = 2e-3;
  options.farfield.farfield_radius = 15.0;
  options.discs = {{.name = "fan", .center = {-0.3, 0, 0}, .radius = 1.5}, {.name = "prop", .center = {-1.6, 0, 0}, .radius = 1.2}};
  const RunContext context({.threads = 2});
  const auto folder = test::scratch();
  io::write_volume_file(volume_mesh(wall, options, context).mesh, folder / "fan.sterna", context);
  const test::ProcessResult result =
      test::run_process((test::source_folder() / "tools/accept_mesh").string(), {"fan.sterna", "--sterna", test::sterna_program().string()}, folder);
  constexpr int k_not_installed = 77;
  STERNA_NEEDS((result.status == k_not_installed ? std::optional<int>() : std::optional<int>(result.status)), "the Debian packages openfoam and cgns-convert");
  EXPECT_EQ(result.status, 0) << result.output << result.errors;
}

}  // namespace
}  // namespace sterna::volmesh
