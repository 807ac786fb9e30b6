// Defects forced by the input surface under a layer: each proof on a mesh where it holds, on a similar one where it does not, and never beyond real meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geom/mesh/check_parts.h"
#include "geom/mesh/forced_layer.h"
#include "tests/geom/mesh/check_support.h"
#include "tests/support/test_constants.h"

namespace sterna {
namespace {

using namespace test;
using check_parts::ColumnSide;
using check_parts::GivenLayer;
using test::k_degree;

std::vector<ColumnSide> inner_sides(const HybridMesh& mesh) {
  std::vector<std::uint32_t> neighbours;
  check_parts::find_open_sides(mesh.layers, RunContext({.threads = 1}), &neighbours);
  std::vector<ColumnSide> sides;
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    for (int j = 0; neighbours[i] != check_parts::k_no_slot && j < mesh.layers.n_layers; ++j) sides.push_back({i / 3, i % 3, neighbours[i], j});
  return sides;
}

int n_of_sides(const GateResult& gate) {
  int n = 0;
  for (const GateLocation& location : gate.locations) n += location.what.starts_with("side of") ? 1 : 0;
  return n;
}

/// Returns a plate of 4 x 4 squares whose second row across x is `width` wide instead of 0.25, from layer `from` on.
HybridMesh plate_with_strip(double width, double layer_height, int from = 0) {
  HybridMesh mesh = plate_block(4, {.n_layers = 3, .layer_height = layer_height, .ratio = 1.2, .outer_height = 2.0 * layer_height});
  const auto squeezed = [&](double x) { return x <= 0.25 ? x : x <= 0.5 ? 0.25 + (x - 0.25) * width / 0.25 : x - 0.25 + width; };
  std::vector<std::uint8_t> stays(mesh.points.size(), 0);
  for (std::uint32_t line = 0; line < mesh.layers.n_lines(); ++line)
    for (int j = 0; j < from; ++j) stays[mesh.layers.node(line, j).index()] = 1;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    if (stays[i] == 0) mesh.points.raw()[i].x = squeezed(mesh.points.raw()[i].x);
  return mesh;
}

TEST(ForcedLayer, WeightsAndVolumesOfUnequalWallTriangles) {
  const CheckReport thin = checked(plate_with_strip(0.001, 1e-5));
  for (const Measure measure : {Measure::face_weight, Measure::volume_ratio}) {
    const GateResult& gate = thin.gate(measure);
    EXPECT_GT(gate.n_forced, 0) << to_text(gate);
    EXPECT_EQ(n_of_sides(gate), 0) << to_text(gate);  // all column sides beyond the limit are forced by the input surface
    ASSERT_FALSE(gate.forced.empty());
    EXPECT_NE(gate.forced.front().forcing.remedy.find("remesh the wall"), std::string::npos);
  }
  // The wall is regular, so the defect in the layer above is the mesher's.
  const CheckReport above = checked(plate_with_strip(0.001, 1e-5, 1));
  EXPECT_EQ(above.gate(Measure::face_weight).n_forced, 0);
  EXPECT_GT(n_of_sides(above.gate(Measure::face_weight)), 0);
  EXPECT_TRUE(above.gate(Measure::face_weight).is_hard_missed);
  // A layer that is thicker than the strip is wide could have leant.
  const CheckReport thick = checked(plate_with_strip(0.001, 0.2));
  EXPECT_EQ(thick.gate(Measure::face_weight).n_forced, 0);
  EXPECT_EQ(thick.gate(Measure::volume_ratio).n_forced, 0);
}

/// Returns a plate with 4 layers that grow by 1.25, whose request permits the given growth.
HybridMesh low_plate(double requested_growth) {
  HybridMesh mesh = plate_block(4, {.n_layers = 4, .layer_height = 0.01, .ratio = 1.25, .outer_height = 0.2});
  mesh.request.first_height = 0.01 / 5.765625;
  mesh.request.max_growth = requested_growth;
  mesh.request.target_height.assign(mesh.layers.n_lines(), 0.01);
  mesh.request.reason.assign(mesh.layers.n_lines(), 0);
  mesh.request.reasons = {"none"};
  return mesh;
}

TEST(ForcedLayer, LastHeightsThatTheRequestKeepsLow) {
  const GateResult requested = checked(low_plate(1.25)).gate(Measure::interface_height);
  EXPECT_GT(requested.n_beyond_hard, 0);
  EXPECT_EQ(requested.n_forced, requested.n_beyond_hard) << to_text(requested);
  EXPECT_FALSE(requested.is_hard_missed);
  EXPECT_NE(requested.forced.front().forcing.remedy.find("more layers"), std::string::npos);
  // With this growth ratio the last cell could have been 30 times as high.
  const GateResult ours = checked(low_plate(3.0)).gate(Measure::interface_height);
  EXPECT_EQ(ours.n_forced, 0);
  EXPECT_TRUE(ours.is_hard_missed);
}

TEST(ForcedLayer, LastHeightsThatAGapKeepsLow) {
  const HybridMesh mesh = low_plate(3.0);
  const GivenLayer given(mesh);
  const std::vector<double> narrow(mesh.layers.n_lines(), 0.01), wide(mesh.layers.n_lines(), 0.1);
  const auto forced = given.interface_height(0, narrow, 8.0);
  ASSERT_TRUE(forced);
  EXPECT_NE(forced->remedy.find("truncate"), std::string::npos);
  EXPECT_FALSE(given.interface_height(0, wide, 8.0));
  EXPECT_FALSE(given.interface_height(0, {}, 8.0));
}

struct SharpEdge {
  double half_angle = 1.2 * k_degree;
  double lower_chord = 1.0;  ///< chord of the lower side over that of the upper side
  double lower_shift = 0.0;  ///< shift of the lower side along the edge
  double height = 2e-4;      ///< layer height
  double off_middle = 0.0;   ///< rad, inclination of the edge's growth lines to the middle direction
  double leaning = 0.0;      ///< rad, random inclination of all growth lines
};

/// Returns the two sides of a wing's rear that meet along the y axis: five nodes on the edge, four opposite nodes on each side.
HybridMesh sharp_edge(const SharpEdge& edge) {
  TriMesh wall;
  wall.patches.push_back({"wing", PatchKind::wall});
  std::vector<Vec3> rays;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> chance(-1.0, 1.0);
  const auto add = [&](const Point& p, const Vec3& ray, double within) {
    wall.points.push_back(p);
    Vec3 turned = ray + within * Vec3{chance(random), chance(random), chance(random)} / std::numbers::sqrt3;
    rays.push_back(normalized(turned));
  };
  const double c = std::cos(edge.half_angle), s = std::sin(edge.half_angle);
  for (int i = 0; i < 5; ++i) {
    const double angle = edge.off_middle + 0.4 * edge.half_angle * (edge.leaning > 0.0 ? chance(random) : 0.0);
    wall.points.push_back({0, static_cast<double>(i), 0});
    rays.push_back(normalized(Vec3{std::cos(angle), std::tan(edge.leaning) * chance(random), std::sin(angle)}));
  }
  for (int i = 0; i < 4; ++i) add({-c, i + 0.5, s}, {s, 0, c}, std::tan(edge.leaning));
  for (int i = 0; i < 4; ++i) add({-edge.lower_chord * c, i + 0.5 + edge.lower_shift, -edge.lower_chord * s}, {s, 0, -c}, std::tan(edge.leaning));
  const auto triangle = [&](int i, int j, int k) { wall.triangles.push_back({VertexId(i), VertexId(j), VertexId(k)}); };
  for (int i = 0; i < 4; ++i) {
    triangle(i, i + 1, 5 + i);
    triangle(i + 1, i, 9 + i);
    if (i == 3) continue;
    triangle(i + 1, 6 + i, 5 + i);
    triangle(i + 1, 9 + i, 10 + i);
  }
  wall.triangle_patch.assign(wall.triangles.size(), PatchId(0));
  return extrude(wall, rays, {.n_layers = 3, .layer_height = edge.height, .ratio = 1.3, .outer_height = 2.0 * edge.height});
}

TEST(ForcedLayer, SkewnessAtASharpEdge) {
  const CheckReport sharp = check(sharp_edge({}), {.intersections = false}, RunContext({.threads = 1}));
  const GateResult& gate = sharp.gate(Measure::skewness);
  EXPECT_GT(gate.n_beyond_hard, 0);
  EXPECT_EQ(gate.n_forced, gate.n_beyond_hard) << to_text(gate);
  EXPECT_NE(gate.forced.front().forcing.remedy.find("several normals"), std::string::npos);
  // Neither sides shifted against each other nor a blunt edge force such skewness.
  const HybridMesh shifted = sharp_edge({.lower_shift = 0.3}), blunt = sharp_edge({.half_angle = 12 * k_degree});
  for (const HybridMesh* mesh : {&shifted, &blunt})
    for (const ColumnSide& side : inner_sides(*mesh)) EXPECT_FALSE(GivenLayer(*mesh).skewness(side, info_of(Measure::skewness).limits.hard));
  // Where the layer is as thick as the triangles are long, the positions of the column sides depend on the growth lines.
  const HybridMesh thick = sharp_edge({.height = 0.3});
  for (const ColumnSide& side : inner_sides(thick)) EXPECT_FALSE(GivenLayer(thick).skewness(side, info_of(Measure::skewness).limits.hard));
}

TEST(ForcedLayer, SkewnessThatTheBareEdgeHas) {
  // A wedge of 6 degrees: 5 / (2 sin 3 degrees) for opposite triangles, in thin layers.
  const double hard = info_of(Measure::skewness).limits.hard, value = 2.5 / std::sin(3 * k_degree);
  const HybridMesh thin = sharp_edge({.half_angle = 3 * k_degree, .height = 1e-4});
  const GateResult gate = check(thin, {.intersections = false}, RunContext({.threads = 1})).gate(Measure::skewness);
  EXPECT_NEAR(gate.worst, value, 0.02 * value);
  EXPECT_GT(gate.n_beyond_hard, 0);
  EXPECT_EQ(gate.n_forced, gate.n_beyond_hard) << to_text(gate);
  // Skewness beyond the edge's bound is caused by the layer; blunt edges, and triangles that are not opposite each other, force no skewness.
  const auto n_reported = [&](const HybridMesh& mesh, double measured) {
    const GivenLayer given(mesh);
    return std::ranges::count_if(inner_sides(mesh), [&](const ColumnSide& side) { return given.skewness_of_edge(side, hard, measured).has_value(); });
  };
  EXPECT_EQ(n_reported(thin, value), 4 * 3 * 2);  // edges, layers, columns
  EXPECT_EQ(n_reported(thin, 1.2 * value), 0);
  EXPECT_EQ(n_reported(sharp_edge({.half_angle = 8 * k_degree}), hard), 0);
  EXPECT_EQ(n_reported(sharp_edge({.half_angle = 3 * k_degree, .lower_shift = 0.4}), hard), 0);
}

TEST(ForcedLayer, OrthogonalityBetweenFacetsOfUnequalSize) {
  const double hard = info_of(Measure::orthogonality).limits.hard;
  const GateResult unequal = check(sharp_edge({.lower_chord = 0.3}), {.intersections = false}, RunContext({.threads = 1})).gate(Measure::orthogonality);
  EXPECT_GT(unequal.n_forced, 0) << to_text(unequal);
  const auto n_proven = [&](const SharpEdge& edge) {
    const HybridMesh mesh = sharp_edge(edge);
    const GivenLayer given(mesh);
    int n = 0;
    for (std::uint32_t i = 0; i < mesh.points.size(); ++i) n += given.orthogonality(NodeId(i), hard) ? 1 : 0;
    return n;
  };
  EXPECT_GT(n_proven({.lower_chord = 0.3}), 0);
  EXPECT_EQ(n_proven({.lower_chord = 0.95}), 0);
  // A wedge of 10 degrees leaves directions that pass the gate; growth lines close to the lower side are the mesher's choice.
  const SharpEdge wide = {.half_angle = 5 * k_degree, .lower_chord = 0.3, .off_middle = -4.9 * k_degree};
  EXPECT_EQ(n_proven(wide), 0);
  EXPECT_EQ(check(sharp_edge(wide), {.intersections = false}, RunContext({.threads = 1})).gate(Measure::orthogonality).is_hard_missed, true);
}

// A bound must hold for every mesh that meets its assumptions: no bound exceeds the worst value of such meshes.
TEST(ForcedLayer, NoBoundIsBeyondWhatAMeshHas) {
  for (const double half_angle : {1.0, 3.0, 8.0})
    for (const double chord : {0.05, 0.4, 1.0})
      for (const double shift : {0.0, 0.2})
        for (const double leaning : {0.0, 5.0}) {
          const HybridMesh mesh = sharp_edge({half_angle * k_degree, chord, shift, 1e-4, 0.0, leaning * k_degree});
          SCOPED_TRACE(testing::Message() << half_angle << " " << chord << " " << shift << " " << leaning);
          const CheckReport report = check(mesh, {.intersections = false}, RunContext({.threads = 1}));
          ASSERT_TRUE(report.dual_checked);
          const GivenLayer given(mesh);
          for (const ColumnSide& side : inner_sides(mesh)) {
            EXPECT_FALSE(given.face_weight(side, report.gate(Measure::face_weight).worst));
            EXPECT_FALSE(given.volume_ratio(side, report.gate(Measure::volume_ratio).worst));
            EXPECT_FALSE(given.skewness(side, report.gate(Measure::skewness).worst));
          }
          for (std::uint32_t i = 0; i < mesh.points.size(); ++i) EXPECT_FALSE(given.orthogonality(NodeId(i), report.gate(Measure::orthogonality).worst));
        }
}

}  // namespace
}  // namespace sterna
