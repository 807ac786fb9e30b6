// growth = "uniform": flat cells of all growth lines have the same growth ratio, so that faces between the prisms of a column do not lean, also where lines are
// compressed or turn around edges.
#include <gtest/gtest.h>

#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/support/voxels.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

/// Two cubes of edge 1, as one wall, with a gap that leaves their layers a fraction of their height.
TriMesh two_cubes(double gap) {
  TriMesh wall = test::cube(6), other = test::cube(6);
  for (Point& p : other.points) p.x += 1.0 + gap;
  append(wall, other);
  return wall;
}

MeshCase cube_case(const char* growth) {
  MeshCase mesh_case;
  mesh_case.envelope.layers = k_automatic_count;
  mesh_case.envelope.first_height = 2e-6;
  mesh_case.envelope.max_growth = 1.25;
  mesh_case.envelope.growth = growth;
  mesh_case.farfield.farfield_radius = 20.0;
  return mesh_case;
}

TEST(UniformGrowth, FacesWithinColumnsDoNotLean) {
  const TriMesh wall = two_cubes(0.3);
  const VolumeMeshResult uniform = volume_mesh(wall, cube_case("uniform"), k_context), local = volume_mesh(wall, cube_case("local"), k_context);
  for (const VolumeMeshResult* result : {&uniform, &local}) {
    ASSERT_TRUE(result->check.is_valid()) << to_text(result->check);
    EXPECT_TRUE(result->certificate.is_proved()) << to_text(result->certificate);
  }
  EXPECT_EQ(uniform.mesh.layers.n_layers, local.mesh.layers.n_layers) << "chosen by the walls alone";
  const GateResult &even = uniform.check.gate(Measure::stacked_orthogonality), &own = local.check.gate(Measure::stacked_orthogonality);
  EXPECT_EQ(even.total, static_cast<double>(count_cells(uniform.mesh).prisms) * (1.0 - 1.0 / uniform.mesh.layers.n_layers)) << "one face less than prisms";
  EXPECT_LT(even.worst, 80.0 * k_degree);
  EXPECT_GT(own.worst, 85.0 * k_degree) << "these walls are no test any more";
  EXPECT_LT(uniform.check.gate(Measure::stacked_skewness).worst, 4.0);
  EXPECT_NE(uniform.check.gate(Measure::first_height).state, GateState::fail) << to_text(uniform.check);
  EXPECT_GT(uniform.layer.compressed_area, 0.0) << "first cells in the gap are lower, which is told";
  EXPECT_LT(uniform.layer.compressed_area, 0.5);
}

/// Few layers on a coarse ball, thin compared with its edges: the requested height leaves room for the first heights above the facets.
TEST(UniformGrowth, ThinLayersOnCoarseWallsKeepFirstHeights) {
  MeshCase mesh_case;
  mesh_case.envelope.layers = 12;
  mesh_case.envelope.first_height = 1e-4;
  mesh_case.farfield.farfield_radius = 20.0;
  const VolumeMeshResult result = volume_mesh(test::sphere(3, 1.0), mesh_case, k_context);
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_EQ(result.layer.compressed_area, 0.0);
  EXPECT_LT(result.check.gate(Measure::first_height).worst, 0.021) << to_text(result.check);
}

/// Around a vertex without a layer, growth lines rise in proportion to their distance from the vertex, so that the cells of pyramids beside it grow like all
/// others.
TEST(UniformGrowth, FacesBesideVertexWithoutLayerDoNotLean) {
  const TriMesh wall = test::chain_of_cubes(4);
  const VolumeMeshResult result = volume_mesh(wall, cube_case("uniform"), k_context);
  ASSERT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_GT(count_cells(result.mesh).pyramids, 0) << "this wall is no test any more";
  EXPECT_LT(result.check.gate(Measure::stacked_orthogonality).worst, 85.0 * k_degree);
  EXPECT_GT(result.check.gate(Measure::volume_ratio).worst, 0.003);
}

TEST(UniformGrowth, IsTheSameForAnyNumberOfThreads) {
  const TriMesh wall = two_cubes(0.3);
  const VolumeMeshResult one = volume_mesh(wall, cube_case("uniform"), RunContext({.threads = 1}));
  for (const int threads : {2, 7}) EXPECT_EQ(volume_mesh(wall, cube_case("uniform"), RunContext({.threads = threads})).mesh.points, one.mesh.points);
}

}  // namespace
}  // namespace sterna::volmesh
