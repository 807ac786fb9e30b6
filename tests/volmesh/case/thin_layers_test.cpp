// Reports before meshing whether layers reach the size of the tetrahedra on them.
#include "volmesh/case/thin_layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geom/math/constants.h"
#include "tests/support/test_shapes.h"

namespace sterna::volmesh {
namespace {

MeshCase requested(int layers) {
  MeshCase mesh_case;
  mesh_case.envelope.layers = layers;
  mesh_case.envelope.first_height = 1e-4;
  mesh_case.envelope.max_growth = 1.3;
  return mesh_case;
}

TEST(ThinLayers, ReportsSufficientNumberOnlyWhereTooFew) {
  const TriMesh cube = test::cube(4);  // all triangles are equal
  const auto thin = thin_layers(cube, requested(8));
  ASSERT_TRUE(thin.has_value());
  EXPECT_DOUBLE_EQ(thin->share, 1.0);
  EXPECT_FALSE(thin_layers(cube, requested(thin->enough)).has_value());
  EXPECT_TRUE(thin_layers(cube, requested(thin->enough - 1)).has_value());
  // Hand calculation: legs of a quarter and their diagonal.
  const double edge = (0.5 + 0.25 * std::sqrt(2.0)) / 3.0, expected = k_regular_height * edge / 3.0;
  EXPECT_EQ(thin->enough, 1 + static_cast<int>(std::ceil(std::log(expected / 1e-4) / std::log(1.3))));
}

TEST(ThinLayers, IsSilentForSeveralRequests) {
  const TriMesh cube = test::cube(4);
  MeshCase with_height = requested(8), with_rule = requested(8), member = requested(8);
  with_height.envelope.total_height = 0.1;
  with_rule.patches = {{.names = "*", .options = {{"layers", 20}}}};
  member.family.refinement = 1.5;
  for (const MeshCase& mesh_case : {with_height, with_rule, member}) EXPECT_FALSE(thin_layers(cube, mesh_case).has_value());
}

}  // namespace
}  // namespace sterna::volmesh
