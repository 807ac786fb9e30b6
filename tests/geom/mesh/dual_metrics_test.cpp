// SU2's dual metrics: hand-worked cells, and two implementations against each other on meshes of every kind of cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/math/measures.h"
#include "geom/math/sub_volumes.h"
#include "tests/geom/mesh/check_support.h"
#include "tests/geom/mesh/naive_dual.h"

namespace sterna {
namespace {

using namespace test;

constexpr double k_degree = std::numbers::pi / 180.0;
/// Angles inside columns come from a polynomial good to 2e-8; elsewhere from acos, which near 0 and 180 degrees turns rounding into as much.
constexpr double k_angle_error = 5e-8;

Column<NodeId, NodeMetrics> metrics_of(const HybridMesh& mesh) {
  const auto result = dual_metrics(mesh, RunContext({.threads = 1}));
  const auto other = dual_metrics(mesh, RunContext({.threads = 7}));
  for (const NodeId node : result.ids()) {
    EXPECT_TRUE(result[node].orthogonality == other[node].orthogonality && result[node].volume == other[node].volume && result[node].closure == other[node].closure);
  }
  return result;
}

void expect_as_naive(const HybridMesh& mesh, double relative = 1e-9) {
  const auto result = metrics_of(mesh);
  const NaiveDual naive = naive_dual(mesh);
  double volume = 0.0;
  for (const NodeId node : result.ids()) {
    const NodeMetrics &a = result[node], &b = naive.nodes[node.index()];
    SCOPED_TRACE("node " + std::to_string(node.value()));
    ASSERT_NEAR(a.orthogonality, b.orthogonality, k_angle_error);
    ASSERT_NEAR(a.face_area_ratio, b.face_area_ratio, relative * b.face_area_ratio);
    ASSERT_NEAR(a.sub_volume_ratio, b.sub_volume_ratio, relative * b.sub_volume_ratio);
    ASSERT_NEAR(a.volume, b.volume, relative * b.volume);
    ASSERT_LT(a.closure, 1e-14);
    volume += a.volume;
  }
  const CheckReport report = check(mesh, {.intersections = false}, RunContext({.threads = 2}));
  EXPECT_NEAR(volume, report.total_volume, 1e-12 * report.total_volume);
}

TEST(DualMetrics, AgreeWithTheDefinitionsInBothForms) {
  for (const HybridMesh& mesh : {sphere_shell(3), cube_shell(3, {.n_layers = 7, .ratio = 1.3}), plate_block(3), plate_block(3, {.n_layers = 1}), plate_block(4, {.n_layers = 2}),
                                 sphere_shell(5, {.n_layers = 9, .layer_height = 0.1, .ratio = 1.4}), hexahedra_block(3), hexahedron_with_roof()}) {
    expect_as_naive(mesh);
    expect_as_naive(explicit_cells(mesh));
  }
}

TEST(DualMetrics, AgreeAroundCollapsedLines) {
  for (const std::vector<std::uint32_t>& collapsed : {std::vector<std::uint32_t>{5}, {5, 6}, {5, 6, 7, 20, 21}}) {
    expect_as_naive(sphere_shell(4, {.n_layers = 6, .collapsed = collapsed}));
    expect_as_naive(plate_block(4, {.n_layers = 6, .collapsed = collapsed}));
    expect_as_naive(explicit_cells(plate_block(4, {.n_layers = 6, .collapsed = collapsed})));
  }
}

}  // namespace
}  // namespace sterna
