// Real surfaces whose parts cross. Each union is either a wall that is meshed with layers to a VALID mesh, or an error with its location.
#include <gmock/gmock.h>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/geom/boolean/bodies.h"
#include "tests/support/data.h"
#include "volmesh/volume_mesh.h"

namespace sterna::test {
namespace {

UnionPart nasty(const std::string& file) {
  const RunContext context = quiet();
  const surfmesh::StitchResult stitched =
      surfmesh::stitch_surface({io::read_surface_file(shared_data() / "surfaces" / "nasty" / file, context)}, {.check_intersections = false}, context);
  return {file, stitched.mesh};
}

ErrorInfo nasty_error(const std::string& file) {
  try {
    unite_meshes({nasty(file)}, {}, quiet());
  } catch (const Error& error) {
    return error.info();
  }
  ADD_FAILURE() << file << " was united";
  return {};
}

void expect_valid_mesh(const TriMesh& wall, int layers, double first_height) {
  volmesh::MeshCase options;
  options.envelope.layers = layers;
  options.envelope.first_height = first_height * body_length(wall);
  const volmesh::VolumeMeshResult mesh = volmesh::volume_mesh(wall, options, quiet());
  EXPECT_TRUE(mesh.check.is_valid()) << to_text(mesh.check);
  EXPECT_GT(mesh.layer.coverage, 0.5);
}

TEST(UniteReal, TwoSpheresBecomeOneWall) {
  STERNA_NEEDS_SHARED_DATA();
  const UnionResult united = unite_meshes({nasty("nasty_arrangements_two_spheres.stl")}, {}, quiet());
  expect_wall(united.mesh);
  EXPECT_EQ(united.report.n_solids, 2);
  EXPECT_EQ(united.report.n_components, 1);
  EXPECT_LE(10 * united.report.after.n_slivers, united.report.before.n_slivers);
  EXPECT_LT(united.report.max_deviation, 1e-3 * body_length(united.mesh));
  expect_valid_mesh(united.mesh, 25, 1e-5);
}

TEST(UniteReal, PropellerHubAndBladesBecomeOneWall) {
  STERNA_NEEDS_SHARED_DATA();
  const UnionResult united = unite_meshes({nasty("uuv_propeller_1.stl")}, {}, quiet());
  expect_wall(united.mesh);
  EXPECT_EQ(united.report.n_solids, 4);
  EXPECT_EQ(united.report.n_components, 1);
  EXPECT_EQ(united.report.after.n_slivers, 0);
  EXPECT_LT(united.report.max_deviation, 1e-3 * body_length(united.mesh));
  expect_valid_mesh(united.mesh, 20, 1e-5);
}

/// The surface has 19 shells. The shell of the body tube crosses itself where the nose joins it, at x = 933; only solids can be united.
TEST(UniteReal, Martlet2NamesTheShellThatCrossesItself) {
  STERNA_NEEDS_SHARED_DATA();
  const ErrorInfo info = nasty_error("martlet_rocket_Martlet2.stl");
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_THAT(info.problem, testing::HasSubstr("component 6 of martlet_rocket_Martlet2.stl"));
  ASSERT_FALSE(info.locations.empty());
  EXPECT_NEAR(info.locations.front().position.x, 933.0, 15.0);
  EXPECT_FALSE(info.geometry.triangles.empty());
}

TEST(UniteReal, HdAirframeNamesItsOpenEdges) {
  STERNA_NEEDS_SHARED_DATA();
  const ErrorInfo info = nasty_error("hd_airframe_HD-airframe-aileron-gap.stl");
  EXPECT_EQ(info.code, ErrorCode::open_surface);
  EXPECT_EQ(info.n_locations, 8);
}

TEST(UniteReal, AShellThatCrossesItselfIsNamed) {
  STERNA_NEEDS_SHARED_DATA();
  const ErrorInfo info = nasty_error("nasty_manifold_self_intersectA.obj");
  EXPECT_EQ(info.code, ErrorCode::self_intersection);
  EXPECT_EQ(info.n_locations, 338);  // tests/data/nasty_surfaces.tsv
}

}  // namespace
}  // namespace sterna::test
