// The automatic number of layers, derived from the walls.
#include "volmesh/envelope/automatic_layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geom/base/error.h"
#include "geom/math/constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/case/layer_choice.h"

namespace sterna::volmesh {
namespace {

MeshCase requested(double first_height) {
  MeshCase mesh_case;
  mesh_case.envelope.layers = k_automatic_count;
  mesh_case.envelope.max_growth = 1.25;
  mesh_case.envelope.first_height = first_height;
  return mesh_case;
}

int layers_of(const TriMesh& surface, const MeshCase& mesh_case) { return with_automatic_layers(surface, mesh_case, RunContext()).envelope.layers; }

TEST(AutomaticLayers, TheLastCellIsHalfARegularTetrahedron) {
  const TriMesh cube = test::cube(4);  // all triangles are equal: legs of a quarter
  const double edge = std::sqrt(4.0 / std::sqrt(3.0) * 0.5 * 0.25 * 0.25), expected = 0.5 * k_regular_height * edge;
  for (const double h0 : {1e-6, 1e-4, 1e-3}) {
    const int n = layers_of(cube, requested(h0));
    const double growth = 1.25;
    EXPECT_GE(h0 * std::pow(growth, n - 1), expected);
    EXPECT_LT(h0 * std::pow(growth, n - 2), expected);
  }
  EXPECT_EQ(layers_of(cube, requested(1.0)), 1);
  MeshCase level = requested(1e-4);
  level.envelope.max_growth = 1.0;
  EXPECT_THROW(layers_of(cube, level), Error);
  MeshCase given = requested(1e-4);
  given.envelope.layers = 7;
  EXPECT_EQ(layers_of(cube, given), 7);
}

TEST(AutomaticLayers, PatchesCountWithWhatTheyAskFor) {
  const TriMesh cube = test::cube(4);
  const int of_all = layers_of(cube, requested(1e-4));
  MeshCase finer = requested(1e-4), slower = requested(1e-4), own = requested(1e-4), none = requested(1e-4), slip = requested(1e-4);
  finer.patches = {{.names = cube.patches[PatchId(0)].name, .options = {{"first_height", 1e-6}}}};
  slower.patches = {{.names = cube.patches[PatchId(0)].name, .options = {{"max_growth", 1.1}}}};
  EXPECT_GT(layers_of(cube, finer), of_all);
  EXPECT_GT(layers_of(cube, slower), of_all);
  own.patches = {{.names = "*", .options = {{"layers", 12}}}};
  EXPECT_EQ(layers_of(cube, own), 12);
  none.patches = {{.names = "*", .options = {{"layers", 0}}}};
  EXPECT_EQ(layers_of(cube, none), 0);
  slip.patches = {{.names = "*", .options = {{"kind", "slip"}}}};
  EXPECT_EQ(layers_of(cube, slip), 1);  // no wall to stand on: an error later
}

/// A member of a mesh family has more layers in proportion to its refinement.
TEST(AutomaticLayers, FollowTheMemberOfAFamily) {
  const TriMesh coarse = test::cube(4), fine = test::cube(8);
  MeshCase member = requested(1e-4);
  member.family.refinement = 2.0;
  const int n = layers_of(coarse, requested(1e-4)), n_fine = layers_of(fine, effective_options(member, RunContext()));
  EXPECT_NEAR(n_fine, 2.0 * n, 2.0);
}

TEST(AutomaticLayers, ATotalHeightIsSolvedForTheLayers) {
  MeshCase mesh_case = requested(1e-4);
  mesh_case.envelope.total_height = 0.05;
  const EnvelopeOptions found = effective_options(mesh_case, RunContext()).envelope;
  EXPECT_GT(found.layers, 1);
  mesh_case.envelope.solve_for = "max_growth";
  EXPECT_ANY_THROW(effective_options(mesh_case, RunContext()));
}

}  // namespace
}  // namespace sterna::volmesh
