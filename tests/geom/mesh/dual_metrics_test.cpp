// SU2's dual metrics: hand-worked cells, and two implementations against each other on meshes of every kind of cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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

Cell only_cell(const HybridMesh& mesh) {
  Cell result;
  for_each_cell(mesh, [&](const Cell& cell) { result = cell; });
  return result;
}

/// Smallest sub-tet of a lone cell by the definitions.
double least_sub_volume(CellKind kind, const std::vector<Point>& points) {
  HybridMesh mesh;
  mesh.points = Column<NodeId, Point>(points);
  std::array<NodeId, 6> nodes;
  for (std::size_t k = 0; k < points.size(); ++k) nodes[k] = NodeId(static_cast<std::uint64_t>(k));
  if (kind == CellKind::prism) mesh.prisms.push_back(nodes);
  if (kind == CellKind::pyramid) mesh.pyramids.push_back({nodes[0], nodes[1], nodes[2], nodes[3], nodes[4]});
  EXPECT_EQ(are_sub_volumes_positive(mesh, only_cell(mesh)), naive_dual(mesh).least_sub_volume > 0.0);
  return naive_dual(mesh).least_sub_volume;
}

TEST(SubVolumes, SignsAreThoseOfTheDefinitionOnRandomPrismsAndPyramids) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  int n_positive = 0, n_valid_but_negative = 0;
  for (int i = 0; i < 20000; ++i) {
    WedgePoints p = {Point{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    for (Point& x : p) x += Vec3{shift(random), shift(random), shift(random)};
    const double least = least_sub_volume(CellKind::prism, {p.begin(), p.end()});
    ASSERT_EQ(are_sub_volumes_positive(p), least > 0.0) << i;
    n_positive += least > 0.0;
    n_valid_but_negative += is_wedge_valid(p) && least <= 0.0;
    std::array<Vec3, 5> q = {Point{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
    for (Point& x : q) x += Vec3{shift(random), shift(random), shift(random)};
    ASSERT_EQ(are_sub_volumes_positive(q), least_sub_volume(CellKind::pyramid, {q.begin(), q.end()}) > 0.0) << i;
  }
  EXPECT_GT(n_positive, 100);
  EXPECT_GT(n_valid_but_negative, 10);  // so the gate says something that G3 does not
}

}  // namespace
}  // namespace sterna
