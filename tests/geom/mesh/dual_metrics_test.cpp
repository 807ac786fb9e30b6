// SU2's dual metrics: cells calculated by hand, and two implementations compared on meshes with every kind of cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geom/math/measures.h"
#include "geom/math/sub_volumes.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/geom/mesh/check_support.h"
#include "tests/geom/mesh/naive_dual.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"
#include "volmesh/volume_mesh.h"

namespace sterna {
namespace {

using namespace test;

using test::k_degree;
/// Angles inside columns come from a polynomial accurate to 2e-8. Other angles come from acos, which near 0 and 180 degrees has rounding errors of this size.
constexpr double k_angle_error = 5e-8;

Column<NodeId, NodeMetrics> metrics_of(const HybridMesh& mesh) {
  const auto result = dual_metrics(mesh, RunContext({.threads = 1}));
  const auto other = dual_metrics(mesh, RunContext({.threads = 7}));
  for (const NodeId node : result.ids()) {
    EXPECT_TRUE(result[node].orthogonality == other[node].orthogonality && result[node].volume == other[node].volume &&
                result[node].closure == other[node].closure);
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
  for (const HybridMesh& mesh :
       {sphere_shell(3), cube_shell(3, {.n_layers = 7, .ratio = 1.3}), plate_block(3), plate_block(3, {.n_layers = 1}), plate_block(4, {.n_layers = 2}),
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

TEST(DualMetrics, AgreeAboutBodiesWithOwnNumbersOfLayers) {
  for (const HybridMesh& mesh : {two_shells(3, 2, 7), two_shells(3, 9, 1), two_shells(4, 6, 3, {.collapsed = {5, 6, 200}}), stepped_sphere_shell(4),
                                 stepped_plate_block(5, {.n_layers = 6, .collapsed = {5, 6, 20}})}) {
    expect_as_naive(mesh);
    expect_as_naive(explicit_cells(mesh));
  }
}

HybridMesh one_cell(const std::vector<Point>& points, const std::vector<std::array<std::size_t, 3>>& triangles,
                    const std::vector<std::array<std::size_t, 4>>& quads) {
  HybridMesh mesh;
  mesh.points = Column<NodeId, Point>(points);
  mesh.patches.push_back({"all", PatchKind::wall});
  for (const auto& t : triangles) mesh.boundary_triangles.push_back({{NodeId(t[0]), NodeId(t[1]), NodeId(t[2])}, PatchId(0)});
  for (const auto& q : quads) mesh.boundary_quads.push_back({{NodeId(q[0]), NodeId(q[1]), NodeId(q[2]), NodeId(q[3])}, PatchId(0)});
  return mesh;
}

HybridMesh right_prism(double height) {
  HybridMesh mesh = one_cell({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, height}, {1, 0, height}, {0, 1, height}}, {{0, 2, 1}, {3, 4, 5}},
                             {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}});
  mesh.prisms.push_back({NodeId(0), NodeId(1), NodeId(2), NodeId(3), NodeId(4), NodeId(5)});
  return mesh;
}

TEST(DualMetrics, RightTetByHand) {
  HybridMesh mesh = one_cell({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, {});
  mesh.tetrahedra.push_back({NodeId(0), NodeId(1), NodeId(2), NodeId(3)});
  const auto m = metrics_of(mesh);
  // Node 0: dual face of edge 0-1 = (2, 1, 1)/24, the other edges by symmetry: area sqrt(6)/24, cosine to the edge 2/sqrt(6), 35.264 degrees.
  EXPECT_NEAR(m[NodeId(0)].orthogonality, (90 - 35.26438968) * k_degree, 1e-9);
  // Boundary piece: a third of each of three faces of area 1/2, (-1, -1, -1)/6, area sqrt(3)/6; over sqrt(6)/24 that is sqrt(8).
  EXPECT_NEAR(m[NodeId(0)].face_area_ratio, std::sqrt(8.0), 1e-14);
  EXPECT_DOUBLE_EQ(m[NodeId(0)].edge_ratio, 1.0);
  // Node 1: the face towards node 0 as above; the faces towards 2 and 3 are normal to their edges, (-1, 1, 0)/24 and (-1, 0, 1)/24.
  EXPECT_NEAR(m[NodeId(1)].orthogonality, (std::sqrt(6.0) * 54.73561032 + 2 * std::sqrt(2.0) * 90) / (std::sqrt(6.0) + 2 * std::sqrt(2.0)) * k_degree, 1e-8);
  EXPECT_NEAR(m[NodeId(1)].edge_ratio, std::sqrt(2.0), 1e-15);
  for (const NodeId node : mesh.points.ids()) {
    EXPECT_NEAR(m[node].sub_volume_ratio, 1.0, 1e-14);  // 24 sub-tets of 1/144
    EXPECT_NEAR(m[node].volume, 1.0 / 24, 1e-16);
    EXPECT_LT(m[node].closure, 1e-15);
  }
}

TEST(DualMetrics, RightPrismsByHand) {
  for (const double h : {1.0, 1e-3, 1e-6}) {
    const HybridMesh mesh = right_prism(h);
    const auto m = metrics_of(mesh);
    // Node 0: towards 1 the dual face (h/6, h/12, 0), area h sqrt(5)/12, 26.565 degrees off the edge; towards 2 its mirror image; upwards (0, 0, 1/6), aligned.
    const double side = h * std::sqrt(5.0) / 12, top = 1.0 / 6;
    EXPECT_NEAR(m[NodeId(0)].orthogonality, (2 * side * 63.43494882 + top * 90) / (2 * side + top) * k_degree, 1e-8);
    // Boundary piece (-h/4, -h/4, -1/6).
    const double boundary = std::sqrt(h * h / 8 + 1.0 / 36);
    EXPECT_NEAR(m[NodeId(0)].face_area_ratio, std::max({side, top, boundary}) / std::min({side, top, boundary}), 1e-9 * boundary / side);
    EXPECT_NEAR(m[NodeId(0)].edge_ratio, 1.0, 1e-15);  // the edge along the growth direction is excluded
    EXPECT_NEAR(m[NodeId(1)].edge_ratio, std::sqrt(2.0), 1e-15);
    for (const NodeId node : mesh.points.ids()) {
      EXPECT_NEAR(m[node].sub_volume_ratio, 1.0, 1e-9);  // 36 sub-tets of h/72, since a straight prism is an affine image
      EXPECT_NEAR(m[node].volume, h / 12, 1e-9 * h);
    }
  }
}

TEST(DualMetrics, CubeAndCubeOfTets) {
  // One hexahedron: dual faces 1/4, aligned; boundary piece (-1, -1, -1)/4.
  const auto hex = metrics_of(hexahedra_block(1));
  for (const NodeMetrics& m : hex) {
    EXPECT_NEAR(m.orthogonality, 90 * k_degree, 1e-7);
    EXPECT_NEAR(m.face_area_ratio, std::sqrt(3.0), 1e-14);
    EXPECT_NEAR(m.sub_volume_ratio, 1.0, 1e-14);
    EXPECT_NEAR(m.volume, 1.0 / 8, 1e-16);
    EXPECT_TRUE(std::isnan(m.edge_ratio));
  }
  // Six tets about the diagonal 0-6, each of volume 1/6. A node on the diagonal belongs to all six (volume 6/24), others to two (2/24); all sub-tets are 1/144.
  HybridMesh mesh = hexahedra_block(1);
  const auto v = mesh.hexahedra.front();
  mesh.hexahedra.clear();
  mesh.boundary_quads.clear();
  const std::array<std::size_t, 7> around = {1, 2, 3, 7, 4, 5, 1};
  for (std::size_t k = 0; k < 6; ++k) mesh.tetrahedra.push_back({v[0], v[around[k]], v[around[k + 1]], v[6]});
  for (std::size_t k = 0; k < 6; ++k) {
    const NodeId a = v[around[k]], b = v[around[k + 1]];
    mesh.boundary_triangles.push_back({{v[0], b, a}, PatchId(0)});
    mesh.boundary_triangles.push_back({{v[6], a, b}, PatchId(0)});
  }
  expect_as_naive(mesh);
  const auto tets = metrics_of(mesh);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(tets[v[k]].volume, (k == 0 || k == 6 ? 6 : 2) / 24.0, 1e-15) << k;
    EXPECT_NEAR(tets[v[k]].sub_volume_ratio, 1.0, 1e-14);
    EXPECT_NEAR(tets[v[k]].edge_ratio, k == 0 || k == 6 ? std::sqrt(3.0) : std::sqrt(2.0), 1e-14);
  }
}

TEST(DualMetrics, PyramidByHand) {
  // Apex over the middle of a unit square, height 1, volume 1/3. Centroid (1/2, 1/2, 1/5). Sub-tets at the apex, on a side (area vector half of 0 1 4), as seen
  // from the centroid: the tet from the side to the centroid has volume (1/3 - base tet 1/3 * 1/5) / 4 = 1/15; each of its six sub-tets has a sixth, 1/90.
  // Sub-tets on the base: the pyramid from the base to the centroid has 1/15; each of its eight sub-tets has an eighth, 1/120.
  HybridMesh mesh = one_cell({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}, {{0, 3, 2, 1}});
  mesh.pyramids.push_back({NodeId(0), NodeId(1), NodeId(2), NodeId(3), NodeId(4)});
  const auto m = metrics_of(mesh);
  EXPECT_NEAR(m[NodeId(4)].volume, 8.0 / 90, 1e-15);
  EXPECT_NEAR(m[NodeId(4)].sub_volume_ratio, 1.0, 1e-14);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(m[NodeId(k)].volume, 4.0 / 90 + 2.0 / 120, 1e-15);
    EXPECT_NEAR(m[NodeId(k)].sub_volume_ratio, 120.0 / 90, 1e-13);
  }
  expect_as_naive(mesh);
}

TEST(DualMetrics, RegularStackHasKnownFaceAreaRatio) {
  // Regular triangles of edge l: the upper dual face is a hexagon of area l^2 sqrt(3)/2 with sides of length l/sqrt(3); at layer height H the ratio is 1.5 l/H.
  constexpr int k_n = 4, k_layers = 8;
  HybridMesh mesh = plate_block(k_n, {.n_layers = k_layers, .layer_height = 0.1, .ratio = 1.0});
  for (Point& p : mesh.points) p = {p.x - 0.5 * p.y, std::sqrt(0.75) * p.y, p.z};
  const auto m = metrics_of(mesh);
  const std::uint32_t middle = 2 * (k_n + 1) + 2;
  for (int j = 1; j < k_layers; ++j) {
    const NodeMetrics& node = m[mesh.layers.node(middle, j)];
    EXPECT_NEAR(node.relative_face_area_ratio, 1.5, 1e-12);
    EXPECT_NEAR(node.face_area_ratio, 1.5 * (1.0 / k_n) / (0.1 / k_layers), 1e-9);
    EXPECT_NEAR(node.orthogonality, 90 * k_degree, 1e-7);
    EXPECT_NEAR(node.edge_ratio, 1.0, 1e-12);
  }
}

TEST(DualMetrics, ThinLayersFarFromTheOrigin) {
  HybridMesh mesh = sphere_shell(8, {.n_layers = 20, .layer_height = 1e-3, .ratio = 1.2});
  move_points(mesh, 1.0, {1e3, -1e3, 1e3});
  const CheckReport report = checked(mesh);
  EXPECT_TRUE(report.is_valid()) << to_text(report);
  EXPECT_LT(report.gate(Measure::dual_closure).worst, 1e-13);
  EXPECT_NEAR(report.dual_volume, report.total_volume, 1e-12 * report.total_volume);
}

/// Sliver triangles 5 m long and 1e-5 m wide, as repair leaves them beside crossings (openscad-nonmanifold-crash.obj: one control volume was reported as open).
/// Rounding of the long edges exceeds 1e-12 of the faces of such cells.
TEST(DualMetrics, NeedlesAreNotOpenByRounding) {
  HybridMesh mesh = plate_block(4, {.n_layers = 6});
  for (Point& p : mesh.points) p = {5.0 * p.x + 0.31 * p.y + 0.17 * p.z, 1e-5 * p.y, 1e-5 * p.z + 0.3e-5 * p.x};
  const CheckReport report = check(mesh, {.intersections = false}, RunContext({.threads = 2}));
  EXPECT_EQ(report.count(Violation::open_dual_cell), 0);
  EXPECT_LT(report.gate(Measure::dual_closure).worst, 1e-12);
}

TEST(DualMetrics, RealMesh) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = io::read_surface_file(shared_data() / "surfaces/clean/pygeo_bwb.stl", RunContext({.threads = 2}));
  const TriMesh wall = surfmesh::stitch_surface({soup}, {}, RunContext({.threads = 2})).mesh;
  volmesh::MeshCase options;
  options.envelope.layers = 6;
  options.envelope.first_height = 1e-4 * body_length(wall);
  options.farfield.farfield_radius = 20 * body_length(wall);
  const volmesh::VolumeMeshResult result = volmesh::volume_mesh(wall, options, RunContext({.threads = 2}));
  expect_as_naive(result.mesh, 1e-6);  // cancellation in the naive version: coordinates of 20 body lengths, cells of 1e-4
  EXPECT_NEAR(result.check.dual_volume, result.check.total_volume, 1e-12 * result.check.total_volume);
  EXPECT_LT(result.check.gate(Measure::dual_closure).worst, 1e-12);
  for (const MeasureInfo& info : measures())
    EXPECT_EQ(result.check.gate(info.measure).state == GateState::not_checked,
              info.measure == Measure::cad_distance || info.measure == Measure::cad_normal || info.measure == Measure::boundary_layer)
        << info.name;  // these measures need a model, or a boundary layer in the request
  // The same mesh without columns, as read from a file: the check finds the growth lines again.
  const CheckReport cells = check(explicit_cells(result.mesh), {.intersections = false}, RunContext({.threads = 2}));
  for (const Measure measure :
       {Measure::stack_growth, Measure::stack_angle, Measure::layer_step, Measure::interface_height, Measure::interface_volume, Measure::sub_volume_ratio})
    EXPECT_NEAR(cells.gate(measure).worst, result.check.gate(measure).worst, 1e-9 * std::abs(cells.gate(measure).worst)) << info_of(measure).name;
  EXPECT_EQ(cells.gate(Measure::first_height).state, GateState::not_checked);
}

Cell only_cell(const HybridMesh& mesh) {
  Cell result;
  for_each_cell(mesh, [&](const Cell& cell) { result = cell; });
  return result;
}

/// Returns the smallest sub-tet volume of a single cell, computed from the definitions.
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

TEST(SubVolumes, SignsMatchDefinitionOnRandomPrismsAndPyramids) {
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
  EXPECT_GT(n_valid_but_negative, 10);  // so this gate finds cells that G3 does not
}

}  // namespace
}  // namespace sterna
