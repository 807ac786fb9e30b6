// The QUALITY gates: how a measure is judged, and each gate on a mesh whose value is known by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "geom/math/spherical_cap.h"
#include "geom/mesh/layer_room.h"
#include "tests/geom/mesh/check_support.h"
#include "tests/support/test_constants.h"

namespace sterna {
namespace {

using namespace test;

using test::k_degree;

GateResult judged(GateScan scan) {
  return scan.result([](std::uint64_t id) { return std::pair(Point{static_cast<double>(id), 0, 0}, "item " + std::to_string(id)); });
}

HybridMesh regular_plate_of_steps();
void request_layer(HybridMesh& mesh, double first_height, double height, double max_growth);

GateResult judged_of(const MeasureInfo& info, const GateLimits& limits, std::int64_t n_good, const std::vector<double>& others) {
  GateScan scan(info, limits);
  for (std::int64_t i = 0; i < n_good; ++i) scan.add(2.0, static_cast<std::uint64_t>(i));
  for (const double value : others) scan.add(value, 1000000);
  return judged(scan);
}

TEST(Gates, PassWarnFailByHardTargetUsualLimits) {
  const MeasureInfo& usual = info_of(Measure::tet_growth);  // upper: hard 20, 4 on 99.9 %
  const auto state_of = [&](std::int64_t n_good, const std::vector<double>& others) { return judged_of(usual, usual.limits, n_good, others).state; };
  EXPECT_EQ(state_of(0, {}), GateState::not_checked);
  EXPECT_EQ(state_of(1, {}), GateState::pass);
  EXPECT_EQ(state_of(999, {4.1}), GateState::pass);  // 99.9 %
  EXPECT_EQ(state_of(998, {4.1}), GateState::warn);
  EXPECT_EQ(state_of(9999, {20.1}), GateState::warn);  // FAIL beyond 0.1 %
  EXPECT_EQ(state_of(998, {20.1, 20.1}), GateState::fail);
  EXPECT_EQ(state_of(9999, {20.0}), GateState::pass);  // a limit itself is kept
  EXPECT_EQ(state_of(9999, {std::numeric_limits<double>::quiet_NaN()}), GateState::warn);
  const MeasureInfo& angle = info_of(Measure::non_orthogonality);  // upper: hard 88 degrees, by runs
  const auto state_at = [&](double degrees) { return judged_of(angle, angle.limits, 0, {degrees * k_degree}).state; };
  EXPECT_EQ(state_at(87.9), GateState::warn);
  EXPECT_EQ(state_at(88.1), GateState::fail);
  EXPECT_EQ(state_at(std::numeric_limits<double>::quiet_NaN()), GateState::fail);
  const MeasureInfo& target = info_of(Measure::skewness);  // upper: hard 20, target 4
  EXPECT_EQ(judged_of(target, target.limits, 9999, {4.1}).state, GateState::warn);

  const MeasureInfo& low = info_of(Measure::min_dihedral);
  GateScan scan(low, low.limits);
  scan.add(4.9 * k_degree, 7);
  EXPECT_EQ(judged(scan).state, GateState::fail);
  EXPECT_NEAR(judged(scan).worst, 4.9 * k_degree, 1e-15);
  EXPECT_EQ(judged(scan).locations.front().what, "item 7");
  EXPECT_EQ(judged(scan).n_too_small, 1);
}

TEST(Gates, ALimitWithoutEvidenceWarns) {
  const MeasureInfo& nodes = info_of(Measure::sub_volume_ratio);  // upper: hard 1e5
  const GateResult cited = judged_of(nodes, nodes.limits, 9, {100001.0});
  EXPECT_TRUE(cited.is_hard_missed);
  EXPECT_EQ(state_for(cited, Consumer::node_centred), GateState::warn);
  EXPECT_EQ(state_for(cited, Consumer::cell_centred), GateState::not_checked);
  EXPECT_EQ(cited.state, GateState::warn);
  GateLimits own = nodes.limits;
  own.hard = 2e4;  // the user's limit
  EXPECT_EQ(judged_of(nodes, own, 9, {100001.0}).state, GateState::fail);
  const MeasureInfo& both = info_of(Measure::tet_growth);
  const GateResult shared = judged_of(both, both.limits, 9, {21.0});
  EXPECT_EQ(state_for(shared, Consumer::cell_centred), GateState::fail);  // by runs
  EXPECT_EQ(state_for(shared, Consumer::node_centred), GateState::warn);
  const MeasureInfo& requested = info_of(Measure::first_height);  // compared with the request, by definition
  EXPECT_EQ(state_for(judged_of(requested, requested.limits, 0, {0.5}), Consumer::node_centred), GateState::fail);
}

TEST(Gates, FirstHeightsFailOnlyAboveAShare) {
  const MeasureInfo& requested = info_of(Measure::first_height);  // hard 0.2, 0.02 on 99 %; FAIL beyond 1 % of the lines
  const auto of = [&](int n_wrong, const GateLimits& limits) {
    GateScan scan(requested, limits);
    for (int i = 0; i < 1000; ++i) scan.add(i < n_wrong ? 0.5 : 0.0, static_cast<std::uint64_t>(i));
    return judged(scan);
  };
  EXPECT_EQ(of(10, requested.limits).state, GateState::warn);
  EXPECT_TRUE(of(10, requested.limits).is_hard_missed);
  EXPECT_NEAR(of(10, requested.limits).share_beyond_hard, 0.01, 1e-15);
  EXPECT_EQ(of(11, requested.limits).state, GateState::fail);
  EXPECT_NE(to_text(of(11, requested.limits)).find("hard <= 0.2 except on 1 %"), std::string::npos) << to_text(of(11, requested.limits));
  GateLimits own = requested.limits;
  own.hard = 0.3;  // the user's: one line is enough
  EXPECT_EQ(of(1, own).state, GateState::fail);
}

TEST(Gates, EveryHardLimitNamesItsEvidence) {
  for (const MeasureInfo& info : measures()) {
    EXPECT_TRUE(info.consumers.cell_centred || info.consumers.node_centred) << info.name;
    for (const Consumer consumer : k_consumers)
      EXPECT_EQ(info.evidence.of(consumer) != Evidence::none, !std::isnan(info.limits.hard) && info.consumers.has(consumer)) << info.name;
    EXPECT_EQ(info.evidence.source.empty(), std::isnan(info.limits.hard)) << info.name;
  }
}

TEST(Gates, ItemsAreCountedOnBothSidesOfLimits) {
  const MeasureInfo& info = info_of(Measure::interface_height);  // hard 8, 3 on 99 %
  std::vector<GateScan> parts(3, GateScan(info, info.limits));
  for (std::uint64_t i = 0; i < 10; ++i) parts[i % 3].add(9.0, i | (i < 4 ? GateScan::k_too_small : 0));
  for (std::uint64_t i = 10; i < 30; ++i) parts[i % 3].add(4.0, i);
  for (std::uint64_t i = 30; i < 100; ++i) parts[i % 3].add(1.0, i);
  GateScan all(info, info.limits);
  for (const GateScan& part : parts) all.merge(part);
  const GateResult result = judged(all);
  EXPECT_EQ(result.n_beyond_hard, 10);
  EXPECT_EQ(result.n_beyond_target, 30);
  EXPECT_EQ(result.n_too_small, 4);
  EXPECT_EQ(result.n_too_large, 6);
  EXPECT_EQ(result.locations.front().what, "item 0");
  EXPECT_NE(to_text(result).find("; 10 prisms beyond the hard limit, 10 % of the volume, 6 too large, 4 too small; 30 beyond the usual limit"),
            std::string::npos)
      << to_text(result);
}

/// Changes the cell heights of one growth line; the plate is 6 x 6.
void jump(HybridMesh& mesh, std::uint32_t line) { mesh.points[mesh.layers.node(line, 2)].z *= 1.5; }

TEST(Gates, PlacesAreClustersOfCellsThatTouch) {
  HybridMesh mesh = regular_plate_of_steps();
  request_layer(mesh, 0.1 / 6.187, 0.1, 1.3);
  jump(mesh, 8);
  jump(mesh, 9);   // a neighbour
  jump(mesh, 40);  // far away
  CheckOptions options;
  options.limits[Measure::stack_growth].hard = 1.45;  // the user's, so that it FAILs
  const CheckReport report = checked(mesh, options);
  const GateResult& growth = report.gate(Measure::stack_growth);
  EXPECT_EQ(growth.state, GateState::fail);
  EXPECT_EQ(growth.n_beyond_hard, 3);
  EXPECT_EQ(growth.n_locations, 2);
  EXPECT_EQ(growth.n_too_large, 3);
  EXPECT_NEAR(growth.share_beyond, 3.0 / 36, 0.02);  // an inner growth line represents one square
  EXPECT_TRUE(growth.extent.empty());
  EXPECT_EQ(report.quality_state(Consumer::cell_centred), GateState::fail);
  ASSERT_EQ(report.verdict_locations.size(), 2u);
  EXPECT_GE(report.verdict_locations[0].n_locations.value(), 1);
  EXPECT_NE(verdict_line(report).find("VALID; cell-centred: FAIL at "), std::string::npos) << verdict_line(report);
}

TEST(Gates, VerdictForOneSolverKindOmitsOthers) {
  HybridMesh mesh = regular_plate_of_steps();
  request_layer(mesh, 0.1 / 6.187, 0.1, 1.3);
  jump(mesh, 8);
  const CheckReport both = checked(mesh), nodes = checked(mesh, {.consumers = {.cell_centred = false, .node_centred = true}}),
                    cells = checked(mesh, {.consumers = {.cell_centred = true, .node_centred = false}});
  EXPECT_EQ(nodes.gate(Measure::non_orthogonality).state, GateState::not_checked);
  EXPECT_EQ(nodes.gate(Measure::stack_growth).state, GateState::warn);  // the limit is a guideline
  EXPECT_EQ(nodes.quality_state(), GateState::warn);
  EXPECT_EQ(cells.gate(Measure::orthogonality).state, GateState::not_checked);
  EXPECT_EQ(cells.gate(Measure::stack_growth).state, GateState::warn);
  EXPECT_EQ(to_text(nodes).find("OpenFOAM"), std::string::npos);
  EXPECT_EQ(to_text(cells).find("SU2"), std::string::npos);
  EXPECT_EQ(verdict_line(nodes).find("cell-centred"), std::string::npos);
  CheckReport restricted = both;
  restricted.restrict_to({.cell_centred = false, .node_centred = true});
  EXPECT_EQ(verdict_line(restricted), verdict_line(nodes));
}

TEST(Gates, TheWorstTenHoweverTheItemsAreDealt) {
  const MeasureInfo& info = info_of(Measure::edge_ratio);
  GateScan whole(info, info.limits);
  std::vector<GateScan> parts(7, GateScan(info, info.limits));
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double value = 11.0 + static_cast<double>(i * 7919 % 100);  // each value ten times
    whole.add(value, i);
    parts[i % 7].add(value, i);
  }
  GateScan merged(info, info.limits);
  for (std::size_t k = parts.size(); k-- > 0;) merged.merge(parts[k]);
  EXPECT_EQ(merged.worst(), whole.worst());
  EXPECT_EQ(whole.worst().size(), GateScan::k_most_locations);
  for (std::size_t k = 1; k < 10; ++k) {
    EXPECT_EQ(whole.worst()[k].badness, 110.0);
    EXPECT_LT(whole.worst()[k - 1].id, whole.worst()[k].id);
  }
  EXPECT_EQ(judged(merged).n_beyond_hard, judged(whole).n_beyond_hard);
}

TEST(Gates, TheTableIsThatOfQualityMd) {
  const GateTable table;
  EXPECT_NEAR(table[Measure::orthogonality].hard, 5 * k_degree, 1e-15);
  EXPECT_EQ(table[Measure::sub_volume_ratio].hard, 1e5);
  EXPECT_EQ(table[Measure::stack_growth].hard, 1.5);
  EXPECT_EQ(table[Measure::interface_height].usual, 3);
  EXPECT_EQ(table[Measure::tet_growth].usual_share, 0.999);
  EXPECT_EQ(table[Measure::edge_ratio].usual, 10);
  EXPECT_TRUE(std::isnan(table[Measure::stack_angle].hard));
}

TEST(Gates, LimitsMayBeOverridden) {
  CheckOptions options;
  options.limits[Measure::tet_growth].hard = 1.0;
  const CheckReport report = checked(sphere_shell(3), options);
  EXPECT_TRUE(report.is_valid());
  EXPECT_EQ(report.gate(Measure::tet_growth).state, GateState::fail);
  EXPECT_EQ(report.quality_state(), GateState::fail);
}

/// A plate of regular triangles of edge 1/n with straight layers.
HybridMesh regular_plate(int n, const ShellOptions& options) {
  HybridMesh mesh = plate_block(n, options);
  for (Point& p : mesh.points) p = {p.x - 0.5 * p.y, std::sqrt(0.75) * p.y, p.z};
  return mesh;
}

HybridMesh regular_plate_of_steps() { return regular_plate(6, {.n_layers = 4, .layer_height = 0.1, .ratio = 1.3}); }

/// Sets a request that the mesh's layers meet.
void request_layer(HybridMesh& mesh, double first_height, double height, double max_growth) {
  mesh.request.first_height = first_height;
  mesh.request.max_growth = max_growth;
  mesh.request.target_height.assign(mesh.layers.n_lines(), height);
  mesh.request.reason.assign(mesh.layers.n_lines(), 0);
  mesh.request.reasons = {"none", "warped"};
}

TEST(Gates, StraightLayersAsAsked) {
  // Heights 1, 1.25, 1.5625 ... of 4 layers: sum (1.25^4 - 1)/0.25 = 5.765625 times the first.
  constexpr double k_height = 0.1, k_first = k_height / 5.765625;
  HybridMesh mesh = regular_plate(4, {.n_layers = 4, .layer_height = k_height, .ratio = 1.25});
  request_layer(mesh, k_first, k_height, 1.25);
  const CheckReport report = checked(mesh);
  EXPECT_NEAR(report.gate(Measure::stack_growth).worst, 1.25, 1e-12);
  EXPECT_EQ(report.gate(Measure::stack_growth).state, GateState::pass);
  EXPECT_NEAR(report.gate(Measure::stack_growth).total, std::sqrt(0.75), 1e-12);  // m^2 of wall
  EXPECT_NEAR(report.gate(Measure::stack_angle).worst, 0.0, 1e-7);
  EXPECT_LT(report.gate(Measure::first_height).worst, 1e-12);
  EXPECT_NEAR(report.gate(Measure::coverage).worst, 1.0, 1e-14);
  EXPECT_EQ(report.gate(Measure::collapsed).worst, 0.0);
  EXPECT_EQ(report.gate(Measure::layer_step).worst, 0.0);
  EXPECT_EQ(report.gate(Measure::layer_step).total, 40 + 16);  // edges of 4 x 4 squares and their diagonals
  ASSERT_EQ(report.coverage.size(), 1u);
  EXPECT_EQ(report.coverage[0].patch, "plate");
  // The last layer has 1.953125 first heights; 0.8165 of the edge 1/4 is the target: the ratio is 0.166, 6.02 times too low.
  EXPECT_NEAR(report.gate(Measure::interface_height).worst, std::sqrt(2.0 / 3.0) * 0.25 / (1.953125 * k_first), 1e-9);
  EXPECT_EQ(report.gate(Measure::interface_height).state, GateState::warn);
}

TEST(Gates, GrowthIsComparedWithRequestOrDefault) {
  HybridMesh mesh = regular_plate(3, {.n_layers = 4, .layer_height = 0.1, .ratio = 1.3});
  EXPECT_EQ(checked(mesh).gate(Measure::stack_growth).state, GateState::warn);  // default 1.2
  EXPECT_EQ(checked(mesh).gate(Measure::first_height).state, GateState::not_checked);
  EXPECT_NE(to_text(checked(mesh)).find("not checked: the mesh does not store the requested layer"), std::string::npos);
  request_layer(mesh, 0.01, 0.1, 1.3);
  EXPECT_EQ(checked(mesh).gate(Measure::stack_growth).state, GateState::pass);
  mesh.points[mesh.layers.node(5, 2)].z *= 1.5;
  const CheckReport report = checked(mesh);
  EXPECT_TRUE(report.gate(Measure::stack_growth).is_hard_missed);
  EXPECT_EQ(report.gate(Measure::stack_growth).locations.front().what, "line 5, patch plate");
  // A request beyond the hard limit does not lift it.
  HybridMesh steep = regular_plate(3, {.n_layers = 4, .layer_height = 0.1, .ratio = 2.0});
  request_layer(steep, 0.1 / 15.0, 0.1, 2.0);
  EXPECT_EQ(checked(steep).gate(Measure::stack_growth).state, GateState::warn);
}

TEST(Gates, EachLineIsMeasuredAgainstItsRequest) {
  // Heights of 4 layers growing by 1.25: sum 5.765625 times the first; of 2 layers 2.25 times.
  constexpr double k_first = 0.1 / 5.765625, k_second = 0.1 / 2.25;
  HybridMesh mesh = two_shells(8, 4, 2, {.layer_height = 0.1, .ratio = 1.25});
  request_layer(mesh, k_first, 0.1, 1.25);
  EXPECT_GT(checked(mesh).gate(Measure::first_height).worst, 1.0);  // from the second body
  for (std::size_t k = 0; k < mesh.layers.n_lines(); ++k) mesh.request.line_first_height.push_back(mesh.layers.layers_of_line(k) == 4 ? k_first : k_second);
  EXPECT_LT(checked(mesh).gate(Measure::first_height).worst, 1e-4);  // rays are slightly inclined to the normals of a faceted sphere
  EXPECT_EQ(checked(mesh).gate(Measure::layer_step).worst, 0.0);
  EXPECT_EQ(checked(mesh).gate(Measure::stack_growth).state, GateState::pass);
  // The second body requests a growth of 1.2: its 1.25 counts as 1.25 * 1.25 / 1.2 against the largest.
  for (std::size_t k = 0; k < mesh.layers.n_lines(); ++k) mesh.request.line_max_growth.push_back(mesh.layers.layers_of_line(k) == 4 ? 1.25 : 1.2);
  const CheckReport report = checked(mesh);
  EXPECT_NEAR(report.gate(Measure::stack_growth).worst, 1.25 * 1.25 / 1.2, 1e-9);
  EXPECT_EQ(report.gate(Measure::stack_growth).state, GateState::warn);
  mesh.request.line_first_height.pop_back();
  EXPECT_EQ(checked(mesh).gate(Measure::first_height).state, GateState::not_checked);
}

TEST(Gates, FirstHeightIsMeasuredAlongNormalWithoutCompression) {
  HybridMesh mesh = regular_plate(3, {.n_layers = 3, .layer_height = 0.3, .ratio = 1.0});
  request_layer(mesh, 0.08, 0.3, 1.2);
  EXPECT_NEAR(checked(mesh).gate(Measure::first_height).worst, 0.1 / 0.08 - 1.0, 1e-12);
  EXPECT_EQ(checked(mesh).gate(Measure::first_height).state, GateState::fail);
  request_layer(mesh, 0.11, 0.3, 1.2);  // three cells of 0.11 do not fit: compressed everywhere
  const CheckReport compressed = checked(mesh);
  EXPECT_EQ(compressed.gate(Measure::first_height).state, GateState::not_checked);
  EXPECT_NEAR(compressed.coverage[0].full, 1.0, 1e-14);  // but at the full requested height
  request_layer(mesh, 0.11, 0.4, 1.2);
  EXPECT_NEAR(checked(mesh).coverage[0].compressed, 1.0, 1e-14);
  request_layer(mesh, 0.08, 0.4, 1.2);
  mesh.request.reason.assign(mesh.layers.n_lines(), 1);
  const CheckReport reduced = checked(mesh);
  EXPECT_NEAR(reduced.coverage[0].reduced, 1.0, 1e-14);
  EXPECT_EQ(reduced.coverage[0].lost.front().first, "warped");
  EXPECT_EQ(reduced.gate(Measure::coverage).state, GateState::warn);  // a height that matches the edges is not a boundary layer height
  EXPECT_EQ(reduced.gate(Measure::boundary_layer).state, GateState::not_checked);
  mesh.request.line_boundary_layer.assign(mesh.layers.n_lines(), 0.32);  // the layer height of 0.3 is more than 0.9 of the boundary layer
  EXPECT_EQ(checked(mesh).gate(Measure::boundary_layer).state, GateState::pass);
  mesh.request.line_boundary_layer.assign(mesh.layers.n_lines(), 0.35);
  EXPECT_EQ(checked(mesh).gate(Measure::boundary_layer).state, GateState::fail);
  EXPECT_EQ(checked(mesh).gate(Measure::boundary_layer).worst, 0.0);
  mesh.request.line_boundary_layer.front() = 0.0;  // required on all other growth lines
  EXPECT_LT(checked(mesh).gate(Measure::boundary_layer).total, checked(mesh).gate(Measure::coverage).total);
  mesh.request.line_boundary_layer.clear();
  // A growth line inclined by 60 degrees is twice as long as its height along the normal; the height is judged.
  for (Point& p : mesh.points) p.x += p.z * std::tan(60 * k_degree);
  request_layer(mesh, 0.1, 0.6, 1.2);
  EXPECT_NEAR(checked(mesh).gate(Measure::first_height).worst, 0.0, 1e-12);
}

TEST(Gates, ForcedValuesAreSeparateAndDoNotFail) {
  const MeasureInfo& info = info_of(Measure::tet_growth);  // upper: 4 on 99.9 %
  GateLimits limits = info.limits;
  limits.hard = 19.0;  // the user's, so that it FAILs
  GateScan scan(info, limits);
  for (std::uint64_t i = 0; i < 100; ++i) scan.add(i < 90 ? 2.0 : 101.0 + static_cast<double>(i), i);
  const auto describe = [](std::uint64_t id) { return std::pair(Point{}, "item " + std::to_string(id)); };
  const auto judged_with = [&](std::uint64_t first_forced) {
    return scan.result(describe, [=](std::uint64_t id, double) { return id >= first_forced ? std::optional(Forcing{"the wall", "remesh"}) : std::nullopt; });
  };
  const GateResult some = judged_with(92);
  EXPECT_EQ(some.state, GateState::fail);
  EXPECT_EQ(some.n_beyond_hard, 10);
  EXPECT_EQ(some.n_forced, 8);
  ASSERT_EQ(some.locations.size(), 2u);
  EXPECT_EQ(some.locations.front().what, "item 91");
  ASSERT_EQ(some.forced.size(), 8u);
  EXPECT_EQ(some.forced.front().what, "item 99");
  EXPECT_EQ(some.forced.front().forcing.remedy, "remesh");
  const GateResult all = judged_with(90);
  EXPECT_EQ(all.state, GateState::pass);
  EXPECT_EQ(all.n_forced, 10);
  EXPECT_TRUE(all.locations.empty());
  EXPECT_NE(to_text(all).find("10 of 10 beyond the hard limit are forced"), std::string::npos);
}

TEST(Gates, EdgeRatiosOfWallAreForcedOthersNot) {
  // The middle growth line is 0.001 from its neighbour in all layers; the layers are lower than this distance.
  HybridMesh mesh = regular_plate(4, {.n_layers = 3, .layer_height = 1e-4});
  const auto move_from = [&](int layer) {
    HybridMesh moved = mesh;
    for (int j = layer; j <= 3; ++j) {
      const Point &at = mesh.points[mesh.layers.node(12, j)], &to = mesh.points[mesh.layers.node(13, j)];
      moved.points[moved.layers.node(12, j)] = to + (1e-3 / distance(at, to)) * (at - to);
    }
    return checked(moved).gate(Measure::edge_ratio);
  };
  const GateResult wall = move_from(0);
  EXPECT_FALSE(wall.is_hard_missed);
  EXPECT_GT(wall.n_beyond_hard, 0);
  EXPECT_EQ(wall.n_forced, wall.n_beyond_hard);
  EXPECT_NE(wall.forced.front().forcing.why.find("the wall has an edge"), std::string::npos);
  const GateResult above = move_from(1);
  EXPECT_TRUE(above.is_hard_missed);
  EXPECT_EQ(above.n_forced, 0);
}

TEST(Gates, TetsInNarrowBoundaryAngleAreForced) {
  const double angle = 2 * k_degree;
  HybridMesh mesh;
  for (const Point& p : {Point{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, std::cos(angle), std::sin(angle)}}) mesh.points.push_back(p);
  mesh.patches.push_back({.name = "wall"});
  mesh.tetrahedra.push_back({NodeId(0), NodeId(1), NodeId(2), NodeId(3)});
  for (const LocalFace& face : cell_faces(CellKind::tetrahedron))
    mesh.boundary_triangles.push_back({{NodeId(face.nodes[0]), NodeId(face.nodes[1]), NodeId(face.nodes[2])}, PatchId(0)});
  const CheckReport report = checked(mesh);
  EXPECT_TRUE(report.is_valid()) << to_text(report);
  const GateResult& gate = report.gate(Measure::min_dihedral);
  EXPECT_NEAR(gate.worst, angle, 1e-12);
  EXPECT_EQ(gate.n_forced, 1);
  EXPECT_NE(gate.state, GateState::fail);
  EXPECT_EQ(report.n_forced(), 1);
  EXPECT_NE(to_json(report).find("\"forced\": 1"), std::string::npos);
}

TEST(Gates, CoverageIsByTheHeightAlongTheNormal) {
  HybridMesh mesh = regular_plate(3, {.n_layers = 3, .layer_height = 0.3, .ratio = 1.0});
  request_layer(mesh, 0.1, 0.32, 1.2);
  EXPECT_NEAR(checked(mesh).coverage[0].full, 1.0, 1e-14);
  for (Point& p : mesh.points) p.x += p.z * std::tan(60 * k_degree);  // twice as long, with unchanged height
  EXPECT_NEAR(checked(mesh).coverage[0].full, 1.0, 1e-14);
  request_layer(mesh, 0.1, 0.6, 1.2);
  EXPECT_NEAR(checked(mesh).coverage[0].full, 0.0, 1e-14);
  EXPECT_NEAR(checked(mesh).coverage[0].reduced, 1.0, 1e-14);
}

TEST(Gates, HeightsLimitedByOpposingWallAreNotRequired) {
  // Equal plates with layers of one height facing each other. Without cells between them the mesh is not a tiling, but LayerRoom can judge its coverage.
  constexpr double k_gap = 1.0, k_target = 0.8, k_edge = 0.5;
  const auto plate = [&](double z, std::array<std::uint32_t, 3> base_lines, double requested) {
    std::array<Point, 3> corners = {Point{-1, -1, z}, {1, -1, z}, {0, 2, z}};
    if (z > 0.0) std::swap(corners[1], corners[2]);
    return FacingTriangle{.corners = corners, .base_lines = base_lines, .requested = requested, .edge = k_edge};
  };
  const RoomRequest line{.line = 0, .base_point = {0, 0, 0}, .normal = {0, 0, 1}, .target = k_target, .edge = k_edge};
  const auto permitted = [&](std::vector<FacingTriangle> boundary, const RoomRequest& of) { return LayerRoom(std::move(boundary), k_context).permitted(of); };
  const FacingTriangle own = plate(0.0, {0, 1, 2}, k_target);
  // Half of the gap left by the kept edges; all of it if no layer grows from the other side; the target if there is room.
  EXPECT_NEAR(permitted({own, plate(k_gap, {3, 4, 5}, k_target)}, line), 0.5 * (k_gap - k_kept_edges * k_edge), 1e-14);
  EXPECT_EQ(permitted({own, plate(k_gap, {3, 4, 5}, 0.0)}, line), k_target);
  EXPECT_NEAR(permitted({own, plate(0.5, {3, 4, 5}, 0.0)}, line), 0.5 - k_kept_edges * k_edge, 1e-14);
  EXPECT_EQ(permitted({own, plate(2.0, {3, 4, 5}, k_target)}, line), k_target);
  // Half of a gap that is narrower than the kept edges, and no limit from the back of a wall.
  EXPECT_NEAR(permitted({own, plate(0.1, {3, 4, 5}, 0.0)}, line), 0.05, 1e-14);
  FacingTriangle back = plate(k_gap, {3, 4, 5}, k_target);
  std::swap(back.corners[0], back.corners[1]);
  EXPECT_EQ(permitted({own, back}, line), k_target);
  // A corner of a cube: its diagonal sees three faces at 0.577. If no direction sees all facets, no layer height is permitted.
  RoomRequest corner = line;
  corner.visibility = 1 / std::sqrt(3.0);
  EXPECT_NEAR(permitted({own}, corner), k_target * corner.visibility / 0.9, 1e-14);
  corner.visibility = -0.1;
  EXPECT_EQ(permitted({own}, corner), 0.0);
}

TEST(Gates, LeanOfFirstCellsBeyondBestPossible) {
  HybridMesh mesh = regular_plate(3, {.n_layers = 6, .layer_height = 0.2});
  for (Point& p : mesh.points) p.x += p.z * std::tan(12 * k_degree);
  const CheckReport report = checked(mesh);
  EXPECT_NEAR(report.gate(Measure::stack_angle).worst, 12 * k_degree, 1e-9);
  EXPECT_EQ(report.gate(Measure::stack_angle).state, GateState::warn);
  EXPECT_EQ(report.gate(Measure::stack_angle).share_within, 0.0);
  // At a cube's corner the best direction, the diagonal, is 54.7 degrees off the normals of its three faces; the shell's rays follow the diagonal.
  EXPECT_LT(checked(cube_shell(2)).gate(Measure::stack_angle).worst, 50 * k_degree);
  const std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_NEAR(smallest_spherical_cap(axes).angle, std::acos(1 / std::sqrt(3.0)), 1e-12);
}

TEST(Gates, CollapsedLinesAreStepsAndLostArea) {
  HybridMesh mesh = regular_plate(4, {.n_layers = 3, .layer_height = 0.1, .collapsed = {12}});  // the middle vertex: six of 32 triangles
  request_layer(mesh, 0.01, 0.1, 2.0);
  const CheckReport report = checked(mesh);
  EXPECT_EQ(report.gate(Measure::layer_step).worst, 3.0);
  EXPECT_EQ(report.gate(Measure::layer_step).n_beyond_hard, 6);
  EXPECT_TRUE(report.gate(Measure::layer_step).is_hard_missed);
  EXPECT_NEAR(report.gate(Measure::collapsed).worst, 2.0 / 32, 1e-14);  // a third of each
  EXPECT_NEAR(report.gate(Measure::coverage).worst, 30.0 / 32, 1e-14);
  // All three growth lines of a triangle are collapsed: the triangle has no cells, but it is wall.
  HybridMesh bare = regular_plate(4, {.n_layers = 3, .layer_height = 0.1, .collapsed = {12, 13, 18}});
  request_layer(bare, 0.01, 0.1, 2.0);
  ASSERT_EQ(checked(bare).coverage.size(), 1u);
  EXPECT_EQ(checked(bare).coverage[0].patch, "plate");
}

TEST(Gates, LinesAreFoundInExplicitPrisms) {
  for (HybridMesh mesh : {sphere_shell(4, {.n_layers = 5, .ratio = 1.3}), plate_block(4, {.n_layers = 5, .collapsed = {12}}), cube_shell(2, {.n_layers = 1})}) {
    const CheckReport columns = checked(mesh);
    HybridMesh cells = explicit_cells(mesh);
    // Prisms turned upside down and rotated, as another program may write them.
    for (std::size_t i = 0; i < cells.prisms.size(); i += 3) {
      const auto p = cells.prisms[i];
      cells.prisms[i] = {p[5], p[4], p[3], p[2], p[1], p[0]};
    }
    const CheckReport found = checked(cells);
    EXPECT_TRUE(found.is_valid()) << to_text(found);
    for (const Measure measure : {Measure::stack_growth, Measure::stack_angle, Measure::layer_step, Measure::interface_height, Measure::interface_volume}) {
      EXPECT_EQ(found.gate(measure).state, columns.gate(measure).state) << info_of(measure).name;
      EXPECT_NEAR(found.gate(measure).worst, columns.gate(measure).worst, 1e-12) << info_of(measure).name;
    }
    EXPECT_NEAR(found.gate(Measure::edge_ratio).worst, columns.gate(Measure::edge_ratio).worst, mesh.layers.n_collapsed(0) == 0 ? 1e9 : 1e-9);
  }
  EXPECT_EQ(checked(hexahedra_block(2)).gate(Measure::stack_growth).reason, "the mesh has no prisms");
}

TEST(Gates, TetsByHand) {
  // Two tets on one face, heights 1 and 6: volume ratio 6. The face is an equilateral triangle; a regular tet's dihedral angle is acos(1/3).
  HybridMesh mesh;
  mesh.patches.push_back({"all", PatchKind::wall});
  const double h = std::sqrt(2.0 / 3.0);
  mesh.points = Column<NodeId, Point>({{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}, {0.5, std::sqrt(1.0 / 12), h}, {0.5, std::sqrt(1.0 / 12), -6 * h}});
  const auto n = [](int i) { return NodeId(i); };
  mesh.tetrahedra = {{n(0), n(1), n(2), n(3)}, {n(0), n(2), n(1), n(4)}};
  for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {2, 0}}) {
    mesh.boundary_triangles.push_back({{n(a), n(b), n(3)}, PatchId(0)});
    mesh.boundary_triangles.push_back({{n(b), n(a), n(4)}, PatchId(0)});
  }
  const CheckReport report = checked(mesh);
  EXPECT_TRUE(report.is_valid()) << to_text(report);
  EXPECT_NEAR(report.gate(Measure::tet_growth).worst, 6.0, 1e-12);
  EXPECT_EQ(report.gate(Measure::tet_growth).total, 1.0);
  EXPECT_EQ(report.gate(Measure::tet_growth).state, GateState::warn);
  // Short edges 1, long edges sqrt(1/3 + 36 * 2/3).
  EXPECT_NEAR(report.gate(Measure::edge_ratio).worst, std::sqrt(1.0 / 3 + 24), 1e-12);
  // The steep tet's base angle: height 6h over the inradius sqrt(1/12).
  EXPECT_NEAR(report.gate(Measure::max_dihedral).worst, std::atan(6 * h / std::sqrt(1.0 / 12)), 1e-12);
}

TEST(Gates, SymmetryPatchesLieInOnePlane) {
  HybridMesh mesh = hexahedra_block(3);
  const PatchId plane = mesh.patches.push_back({"middle", PatchKind::symmetry});
  for (BoundaryQuad& face : mesh.boundary_quads) {
    const bool is_on_plane = std::all_of(face.nodes.begin(), face.nodes.end(), [&](NodeId node) { return mesh.points[node].y == 0.0; });
    if (is_on_plane) face.patch = plane;
  }
  EXPECT_TRUE(checked(mesh).is_valid());
  mesh.points[NodeId(1)].y = 5e-13;  // the body is one metre long
  EXPECT_TRUE(checked(mesh).is_valid());
  mesh.points[NodeId(1)].y = -2e-12;
  const CheckReport report = checked(mesh);
  EXPECT_FALSE(report.is_valid());
  EXPECT_EQ(report.count(Violation::off_symmetry_plane), 1);
  EXPECT_NE(to_text(report).find("node 1 of patch middle is -2e-12 m off the plane y = 0"), std::string::npos) << to_text(report);
}

TEST(Gates, PrismWithNegativeSubVolumeIsInvalid) {
  // Top rotated and shifted over the base: all Jacobians are positive, but the cell's centroid is on the wrong side of a part of a side's cone.
  HybridMesh mesh;
  mesh.patches.push_back({"all", PatchKind::wall});
  mesh.points = Column<NodeId, Point>({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {3, -1, 3}, {3, 0, 3}, {0, -1, 3}});
  const auto n = [](int i) { return NodeId(i); };
  mesh.prisms.push_back({n(0), n(1), n(2), n(3), n(4), n(5)});
  mesh.boundary_triangles = {{{n(0), n(2), n(1)}, PatchId(0)}, {{n(3), n(4), n(5)}, PatchId(0)}};
  mesh.boundary_quads = {{{n(0), n(1), n(4), n(3)}, PatchId(0)}, {{n(1), n(2), n(5), n(4)}, PatchId(0)}, {{n(2), n(0), n(3), n(5)}, PatchId(0)}};
  const CheckReport report = checked(mesh, {.intersections = false});
  EXPECT_EQ(report.count(Violation::invalid_cell), 0);
  EXPECT_EQ(report.count(Violation::negative_sub_volume), 1) << to_text(report);
  EXPECT_EQ(report.counts.size(), 1u) << to_text(report);
  EXPECT_NE(to_text(report).find("prism 0, near patch all has a dual sub-volume that is not positive"), std::string::npos);
  EXPECT_TRUE(std::isinf(report.gate(Measure::sub_volume_ratio).worst));
}

TEST(CheckReport, JsonHasEveryMeasureWithItsLimits) {
  const auto json = nlohmann::json::parse(to_json(checked(sphere_shell(3))));
  ASSERT_EQ(json["measures"].size(), k_n_measures);
  for (const auto& entry : json["measures"]) {
    for (const char* key : {"gate", "measure", "title", "unit", "bound", "state", "limits"}) EXPECT_TRUE(entry.contains(key)) << key;
    if (entry["state"] == "not checked") {
      EXPECT_TRUE(entry.contains("reason"));
    } else {
      for (const char* key : {"worst", "counted", "total", "share_within", "beyond_hard", "places"}) EXPECT_TRUE(entry.contains(key)) << key;
    }
  }
  EXPECT_EQ(json["measures"][2]["measure"], "orthogonality");
  EXPECT_NEAR(json["measures"][2]["limits"]["hard"].get<double>(), 5.0, 1e-12);
  EXPECT_TRUE(json["measures"][5]["limits"]["hard"].is_null());
  EXPECT_NE(json["quality_verdict"], "not checked");
}

/// Layers that end on another wall (a strut on a tunnel wall): the tops of their last prisms touch that wall and must still count as tops, also in a file
/// without columns. (They used to be treated as first cells of multi-normal fans and left out.)
TEST(Gates, TopsBesideAnotherWallCountInFilesToo) {
  HybridMesh mesh = plate_block(1);
  for (Patch& patch : mesh.patches)
    if (patch.name == "side") patch.kind = PatchKind::wall;
  const CheckReport of_columns = check(mesh, {}, RunContext()), of_cells = check(explicit_cells(mesh), {}, RunContext());
  for (const Measure measure : {Measure::interface_height, Measure::interface_volume}) {
    EXPECT_TRUE(std::isfinite(of_columns.gate(measure).worst));
    EXPECT_EQ(of_cells.gate(measure).worst, of_columns.gate(measure).worst);
  }
}

}  // namespace
}  // namespace sterna
