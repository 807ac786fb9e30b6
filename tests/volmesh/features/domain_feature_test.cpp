// Which features the list of a case contains, and what they require of later steps.
#include "volmesh/features/domain_feature.h"

#include <gtest/gtest.h>

#include "tests/support/halves.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/layer_domain/layer_domain.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

MeshCase four_layers() {
  MeshCase options;
  options.envelope.layers = 4;
  options.envelope.first_height = 1e-3;
  options.farfield.farfield_radius = 20.0;
  return options;
}

Domain domain_of(const TriMesh& surface, const MeshCase& options) { return domain_around(surface, validated(surface, options, k_context), k_context); }

TEST(DomainFeature, ListContainsRequestedFeatures) {
  MeshCase options;
  EXPECT_EQ(domain_features(options).size(), 2u);  // splitting of slivers and layer edges
  options.discs.emplace_back();
  EXPECT_EQ(domain_features(options).size(), 3u);
  options.periodic.emplace_back();
  options.wakes.emplace_back();
  EXPECT_EQ(domain_features(options).size(), 5u);
  options.patches.push_back({.names = "*", .options = {{"open_ridges", "always"}}});
  EXPECT_EQ(domain_features(options).size(), 6u);
}

TEST(DomainFeature, ClosedWallNeedsNothing) {
  const Domain domain = domain_of(test::sphere(6), four_layers());
  EXPECT_EQ(domain.features.size(), 2u);
  EXPECT_FALSE(domain.needs.keeps_boundary);
  EXPECT_FALSE(domain.needs.remeshes_outer);
  EXPECT_FALSE(domain.needs.has_own_wall);
  EXPECT_FALSE(domain.needs.converts_cells);
}

TEST(DomainFeature, OuterBoundaryOfHalfModelIsRemeshed) {
  const Domain domain = domain_of(test::cut_off(test::sphere(6), 1, 0.0), four_layers());
  EXPECT_TRUE(domain.needs.keeps_boundary);
  EXPECT_TRUE(domain.needs.remeshes_outer);
  EXPECT_FALSE(domain.needs.has_own_wall);
}

TEST(DomainFeature, FreeDiscIsBaffle) {
  MeshCase options = four_layers();
  options.discs = {{.name = "prop", .center = {-1.7, 0, 0}, .radius = 1.2}};
  const Domain domain = domain_of(test::sphere(6), options);
  EXPECT_TRUE(domain.needs.traits.has_baffles);
  EXPECT_TRUE(domain.needs.keeps_boundary);
  EXPECT_FALSE(domain.needs.remeshes_outer);
  EXPECT_FALSE(domain.needs.has_own_wall);
}

TEST(DomainFeature, OpenedRidgesConvertCells) {
  MeshCase options = four_layers();
  options.ridges = {.open_ridges = "always", .open_angle = 80.0 * test::k_degree};
  const Domain cube = domain_of(test::cube(4), options), sphere = domain_of(test::sphere(6), options);
  EXPECT_TRUE(cube.needs.converts_cells);
  EXPECT_TRUE(cube.needs.has_own_wall);
  EXPECT_FALSE(sphere.needs.converts_cells) << "a wall without ridges stays closed";
}

}  // namespace
}  // namespace sterna::volmesh
