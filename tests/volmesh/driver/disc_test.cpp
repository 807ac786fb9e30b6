// Actuator discs through the whole driver.
#include <gmock/gmock.h>

#include "geom/base/error.h"
#include "geom/mesh/baffles.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/stages.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

MeshCase ten_layers_with(std::vector<ActuatorDisc> discs) {
  MeshCase options;
  options.envelope.layers = 10;
  options.envelope.first_height = 1e-3;
  options.farfield.farfield_radius = 20.0;
  options.discs = std::move(discs);
  return options;
}

/// Returns the number of triangles of the patch with this name.
std::size_t n_triangles_of(const HybridMesh& mesh, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::count_if(mesh.boundary_triangles, [&](const auto& t) { return mesh.patches[t.patch].name == name; }));
}

TEST(Discs, PropellerBeforeBodyAndRingAroundIt) {
  const TriMesh wall = test::sphere(8);
  const std::vector<ActuatorDisc> discs = {{.name = "prop", .center = {-1.7, 0, 0}, .radius = 1.2},
                                           {.name = "fan", .center = {0.2, 0, 0}, .radius = 2.4, .inner_radius = 1.5}};
  for (const char* engine : {"hxt", "tetgen"}) {
    SCOPED_TRACE(engine);
    MeshCase options = ten_layers_with(discs);
    options.tetrahedra.engine = engine;
    const VolumeMeshResult result = volume_mesh(wall, options, k_context);
    EXPECT_TRUE(result.check.is_valid());
    EXPECT_EQ(result.tetra_engine, engine);
    for (const std::string name : {"prop", "fan"}) {
      EXPECT_GT(n_triangles_of(result.mesh, name), 50u);
      EXPECT_EQ(n_triangles_of(result.mesh, name), n_triangles_of(result.mesh, name + ".back"));
    }
    EXPECT_FALSE(find_baffle_sides(result.mesh).empty());
    EXPECT_GT(result.layer.coverage, 0.99);
  }
}

TEST(Discs, LayerKeepsClearOfDiscNearWall) {
  MeshCase options = ten_layers_with({{.name = "prop", .center = {-1.1, 0, 0}, .radius = 0.8}});
  options.envelope.first_height = 0.02;
  const VolumeMeshResult result = volume_mesh(test::sphere(8), options, k_context);
  EXPECT_TRUE(result.check.is_valid());
}

TEST(Discs, StagesByHandGiveTheSameMesh) {
  const TriMesh wall = test::sphere(6);
  const MeshCase options = ten_layers_with({{.name = "prop", .center = {-1.7, 0, 0}, .radius = 1.2}});
  const VolumeMeshResult whole = volume_mesh(wall, options, k_context);
  FilledStage filled = make_tetrahedra(wall, make_envelope(wall, options, {}, k_context), options, {}, k_context);
  const VolumeMeshResult by_hand = finish_mesh(wall, std::move(filled), options, k_context);
  EXPECT_EQ(whole.mesh.points, by_hand.mesh.points);
  EXPECT_EQ(whole.mesh.tetrahedra, by_hand.mesh.tetrahedra);
}

TEST(Discs, DiscRimThroughBodyIsErrorWithLocations) {
  try {
    volume_mesh(test::sphere(6), ten_layers_with({{.name = "prop", .center = {1, 0, 0}, .axis = {0, 1, 0}, .radius = 0.5}}), k_context);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::self_intersection);
    EXPECT_FALSE(error.info().locations.empty());
  }
}

}  // namespace
}  // namespace sterna::volmesh
