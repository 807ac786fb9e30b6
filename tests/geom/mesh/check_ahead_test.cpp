// Checks done before the tetrahedra exist must not change the result of the final check.
#include <gtest/gtest.h>

#include "geom/mesh/check.h"
#include "geom/mesh/check_moved.h"
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
  expect_same_report(stepped_sphere_shell(4));
  expect_same_report(stepped_plate_block(4, {.collapsed = {12}}));
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

/// Moves the nodes of a growth line sideways, in proportion to their height.
void bend(HybridMesh& mesh, std::uint32_t line, double by) {
  const int n = mesh.layers.n_steps(line);
  for (int j = 1; j <= n; ++j) mesh.points[mesh.layers.node(line, j)] += Vec3{0.3, 1.0, -0.5} * (by * j / n);
}

TEST(CheckAhead, WhatMovedIsCheckedAgain) {
  const RunContext context({.threads = 2});
  // About 2000 columns: the results of most chunks are kept. The second growth line is folded through its neighbours.
  for (const auto& [bend_of_7, bend_of_600] : {std::pair(0.002, -0.001), std::pair(0.001, 1.0)}) {
    HybridMesh mesh = sphere_shell(10, {.n_layers = 5, .collapsed = {3}});
    HybridMesh layers = mesh;
    layers.tetrahedra.clear();
    const LayerCheck before = check_ahead(layers, {}, context);
    const std::string known = to_json(check(mesh, {}, context, &before));
    for (HybridMesh* both : {&mesh, &layers}) {
      bend(*both, 7, bend_of_7);
      bend(*both, 600, bend_of_600);
    }
    const std::vector<std::uint32_t> lines = {7, 600};
    const LayerCheck after = check_moved_lines(before, layers, lines, {}, context);
    const CheckReport report = check(mesh, {}, context, &after);
    EXPECT_EQ(to_json(report), to_json(check(mesh, {}, context)));
    EXPECT_NE(to_json(report), known);
    EXPECT_EQ(report.is_valid(), bend_of_600 != 1.0);
  }
}

TEST(CheckAhead, HasNoResultForUnusableMesh) {
  HybridMesh mesh = sphere_shell(2);
  mesh.boundary_triangles.front().nodes[0] = NodeId(1000000);
  EXPECT_EQ(check_ahead(mesh, {}, RunContext({.threads = 2})).parts(), nullptr);
}

}  // namespace
}  // namespace sterna
