// What is checked before the tetrahedra are there must not change what the check says.
#include <gtest/gtest.h>

#include "geom/mesh/check.h"
#include "tests/geom/mesh/check_support.h"

namespace sterna {
namespace {

using namespace test;

void expect_same_report(const HybridMesh& mesh, const CheckOptions& options = {}) {
  HybridMesh layers = mesh;
  layers.tetrahedra.clear();
  for (const int threads : {1, 2}) {
    const RunContext context({.threads = threads});
    const LayerCheck ahead = check_ahead(layers, options, context);
    ASSERT_NE(ahead.parts(), nullptr);
    EXPECT_EQ(to_json(check(mesh, options, context, &ahead)), to_json(check(mesh, options, context)));
  }
}

TEST(CheckAhead, ChangesNothingOnValidMeshes) {
  expect_same_report(sphere_shell(5, {.n_layers = 6}));
  expect_same_report(cube_shell(3, {.n_layers = 4, .collapsed = {0, 5, 6}}));
  expect_same_report(plate_block(4));
  expect_same_report(sphere_shell(3), {.intersections = false});
  expect_same_report(sphere_shell(3), {.quality = false});
}

TEST(CheckAhead, ChangesNothingOnFaultyMeshes) {
  HybridMesh inverted = sphere_shell(3, {.n_layers = 4});
  inverted.points[inverted.layers.node(7, 2)] = inverted.points[inverted.layers.node(7, 0)] * 0.5;
  expect_same_report(inverted);
  HybridMesh crossing = sphere_shell(3, {.n_layers = 4});
  crossing.points[crossing.layers.node(7, 4)] = Point{} - crossing.points[crossing.layers.node(7, 4)];
  expect_same_report(crossing);
}

TEST(CheckAhead, TetrahedraThatReachIntoTheColumnsAreNoticed) {
  HybridMesh mesh = sphere_shell(3, {.n_layers = 4});
  const NodeId inside = mesh.layers.node(3, 2);
  mesh.tetrahedra.front()[0] = inside;
  expect_same_report(mesh);
}

TEST(CheckAhead, KnowsNothingOfAMeshThatCannotBeRead) {
  HybridMesh mesh = sphere_shell(2);
  mesh.boundary_triangles.front().nodes[0] = NodeId(1000000);
  EXPECT_EQ(check_ahead(mesh, {}, RunContext({.threads = 2})).parts(), nullptr);
}

}  // namespace
}  // namespace sterna
