// Meshes that are valid by construction must be proved valid: in column form, as explicit cells, moved, scaled and thin.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "geom/mesh/check.h"
#include "tests/geom/mesh/check_support.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

using namespace test;

void expect_valid_in_both_forms(const HybridMesh& mesh) {
  const CheckReport columns = checked(mesh);
  EXPECT_TRUE(columns.is_valid()) << to_text(columns);
  const CheckReport cells = checked(explicit_cells(mesh));
  EXPECT_TRUE(cells.is_valid()) << to_text(cells);
  EXPECT_EQ(columns.cells.total(), cells.cells.total());
  EXPECT_EQ(columns.cells.prisms, cells.cells.prisms);
  EXPECT_NEAR(columns.total_volume, cells.total_volume, 1e-13 * columns.total_volume);  // same terms, summed in two parts
}

TEST(CheckValid, SpheresAndCubes) {
  expect_valid_in_both_forms(sphere_shell(1));
  expect_valid_in_both_forms(sphere_shell(5, {.n_layers = 6}));
  expect_valid_in_both_forms(cube_shell(1));
  expect_valid_in_both_forms(cube_shell(4, {.n_layers = 1, .n_shells = 1}));
}

TEST(CheckValid, CubeAndPlateHaveTheVolumesOfBoxes) {
  const CheckReport cube = checked(cube_shell(3));
  EXPECT_NEAR(cube.layer_volume, 1.4 * 1.4 * 1.4 - 1.0, 1e-14);  // rounding of numbers of the size of one
  EXPECT_NEAR(cube.total_volume, 26.0, 1e-13);
  const CheckReport plate = checked(plate_block(4));
  EXPECT_NEAR(plate.layer_volume, 0.4, 1e-15);
  EXPECT_NEAR(plate.total_volume, 2.0, 1e-14);
}

TEST(CheckValid, OpenWallsEndOnBoundaryQuads) {
  expect_valid_in_both_forms(plate_block(1));
  expect_valid_in_both_forms(plate_block(5, {.n_layers = 7}));
}

TEST(CheckValid, CollapsedLinesGivePyramidsTetsAndBareWall) {
  // One growth line; two neighbours; a whole triangle; on the sphere and, at the edge of a plate, on the side patch.
  const TriMesh wall = sphere(4);
  const auto& v = wall.triangles[TriangleId(40)];
  const std::vector<std::vector<std::uint32_t>> cases = {{v[0].value()}, {v[0].value(), v[1].value()}, {v[0].value(), v[1].value(), v[2].value()}};
  for (const auto& collapsed : cases) {
    const HybridMesh mesh = sphere_shell(4, {.collapsed = collapsed});
    const CellCounts counts = count_cells(mesh);
    EXPECT_GT(counts.pyramids, 0);
    expect_valid_in_both_forms(mesh);
  }
  const HybridMesh bare = sphere_shell(4, {.collapsed = cases[2]});
  EXPECT_EQ(bare.layers.n_collapsed(40), 3);
  expect_valid_in_both_forms(plate_block(4, {.collapsed = {0}}));
  expect_valid_in_both_forms(plate_block(4, {.collapsed = {1, 2}}));
  expect_valid_in_both_forms(plate_block(4, {.collapsed = {0, 1, 6}}));
  expect_valid_in_both_forms(plate_block(1, {.collapsed = {0, 1, 2, 3}}));
}

TEST(CheckValid, BodiesWithOwnNumbersOfLayers) {
  const TriMesh wall = sphere(4);
  const auto& v = wall.triangles[TriangleId(40)];
  const auto n = static_cast<std::uint32_t>(sphere(4).n_vertices());
  const std::vector<std::uint32_t> collapsed = {v[0].value(), v[1].value(), v[2].value(), n + v[0].value(), n + v[1].value()};
  for (const auto& [first, second] : {std::pair(3, 7), std::pair(7, 3), std::pair(1, 9)}) {
    const HybridMesh mesh = two_shells(4, first, second);
    EXPECT_EQ(count_cells(mesh).prisms, 320 * (first + second));
    expect_valid_in_both_forms(mesh);
    const HybridMesh with_collapsed = two_shells(4, first, second, {.collapsed = collapsed});
    EXPECT_GT(count_cells(with_collapsed).pyramids, 0);
    expect_valid_in_both_forms(with_collapsed);
  }
}

TEST(CheckValid, LinesEndingLowerGivePyramidsAndTets) {
  for (const int n : {2, 5}) {
    const HybridMesh sphere = stepped_sphere_shell(4, {.n_layers = n});
    const CellCounts counts = count_cells(sphere), whole = count_cells(sphere_shell(4, {.n_layers = n}));
    EXPECT_GT(counts.pyramids, 0);
    EXPECT_GT(counts.tetrahedra, whole.tetrahedra);
    EXPECT_LT(counts.prisms, whole.prisms);
    expect_valid_in_both_forms(sphere);
    EXPECT_NEAR(checked(sphere).layer_volume, checked(sphere_shell(4, {.n_layers = n})).layer_volume, 1e-11);
    expect_valid_in_both_forms(stepped_plate_block(5, {.n_layers = n}));
    expect_valid_in_both_forms(stepped_plate_block(5, {.n_layers = n, .collapsed = {0, 7, 8, 14, 35}}));
    EXPECT_EQ(checked(sphere).gate(Measure::layer_step).worst, 1.0);
  }
}

TEST(CheckValid, NumbersOfLayersThatLinesDisagreeOn) {
  HybridMesh mesh = two_shells(2, 3, 7);
  mesh.layers.line_layers[mesh.layers.base[0][0]] = 1;
  EXPECT_NE(to_text(checked(mesh)).find("the layer counts of its lines differ by more than one"), std::string::npos);
  mesh.layers.line_layers[mesh.layers.base[0][0]] = 8;
  EXPECT_NE(to_text(checked(mesh)).find("8 layers, expected 1 to 7"), std::string::npos);
  mesh.layers.line_layers.pop_back();
  EXPECT_NE(to_text(checked(mesh)).find("numbers of layers for"), std::string::npos);
}

TEST(CheckValid, HexahedraAndPyramids) {
  for (const HybridMesh& mesh : {hexahedra_block(1), hexahedra_block(4), hexahedron_with_roof()}) {
    const CheckReport report = checked(mesh);
    EXPECT_TRUE(report.is_valid()) << to_text(report);
  }
  EXPECT_NEAR(checked(hexahedra_block(4)).total_volume, 1.0, 1e-14);
  EXPECT_NEAR(checked(hexahedron_with_roof()).total_volume, 1.0 + 1.0 / 6.0, 1e-14);
}

TEST(CheckValid, MovedAndScaled) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const Vec3& offset : {Vec3{}, Vec3{1e3, -1e3, 500.0}}) {
      if (scale < 1.0 && norm(offset) > 0.0) continue;  // 1e-6 at 1e3: coordinates would be rounded to 1e-7 of the body's size
      HybridMesh mesh = sphere_shell(4, {.n_layers = 5});
      move_points(mesh, scale, scale * offset);
      expect_valid_in_both_forms(mesh);
    }
  }
}

TEST(CheckValid, ThinLayersKeepTheVolumeLimit) {
  // First cell 1e-6 of the body length, the layer 1e-3; cells of aspect ratio 1e5, far from the origin.
  HybridMesh mesh = sphere_shell(16, {.n_layers = 30, .layer_height = 1e-3, .ratio = 1.2});
  move_points(mesh, 1.0, {1e3, 1e3, 1e3});
  const CheckReport report = checked(mesh);
  EXPECT_TRUE(report.is_valid()) << to_text(report);
  EXPECT_LT(report.layer_volume_error, 1e-12);
  EXPECT_LT(report.tet_volume_error, 1e-12);
}

TEST(CheckValid, TwoBodiesApart) {
  HybridMesh mesh = explicit_cells(sphere_shell(2));
  HybridMesh other = explicit_cells(sphere_shell(2));
  move_points(other, 1.0, {10, 0, 0});
  const auto n = static_cast<std::uint32_t>(mesh.points.size());
  const auto shifted = [n](auto nodes) {
    for (NodeId& node : nodes) node = NodeId(node.value() + n);
    return nodes;
  };
  for (const Point& p : other.points) mesh.points.push_back(p);
  for (const auto& c : other.prisms) mesh.prisms.push_back(shifted(c));
  for (const auto& c : other.tetrahedra) mesh.tetrahedra.push_back(shifted(c));
  for (const auto& b : other.boundary_triangles) mesh.boundary_triangles.push_back({shifted(b.nodes), b.patch});
  const CheckReport report = checked(mesh);
  EXPECT_TRUE(report.is_valid()) << to_text(report);
}

TEST(CheckValid, FewFacesPerChunkGiveSameReport) {
  for (HybridMesh mesh : {sphere_shell(4), explicit_cells(sphere_shell(4))}) {
    EXPECT_EQ(to_json(checked(mesh)), to_json(checked(mesh, {.faces_at_a_time = 100})));
    mesh.boundary_triangles.resize(500);
    std::swap(mesh.tetrahedra[900][0], mesh.tetrahedra[900][1]);
    EXPECT_EQ(to_json(checked(mesh)), to_json(checked(mesh, {.faces_at_a_time = 100})));
    EXPECT_EQ(to_json(checked(mesh)), to_json(checked(mesh, {.faces_at_a_time = 0})));
  }
}

TEST(CheckValid, AnEmptyMeshIsNotValid) {
  const CheckReport report = checked(HybridMesh{});
  EXPECT_EQ(report.count(Violation::no_cells), 1);
  EXPECT_EQ(report.counts.size(), 1u);
  EXPECT_EQ(report.total_volume, 0.0);
}

TEST(CheckReport, TextAndJsonNameTheGates) {
  const CheckReport report = checked(sphere_shell(2));
  const std::string text = to_text(report);
  EXPECT_EQ(text.substr(0, 20), "VALID; cell-centred:");
  EXPECT_NE(text.find("G4     dual sub-volumes, closure  pass"), std::string::npos) << text;
  EXPECT_NE(text.find("G20    symmetry, periodic sides   pass"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json["schema"], "sterna-check-2");
  EXPECT_EQ(json["verdict"], "VALID");
  EXPECT_EQ(json["cells"]["prisms"], 240);
  EXPECT_EQ(json["gates"]["G1"]["state"], "pass");
  EXPECT_EQ(json["gates"]["G4"]["state"], "pass");
  EXPECT_TRUE(json["findings"].empty());

  const CheckReport without = checked(sphere_shell(2), {.intersections = false, .quality = false});
  EXPECT_TRUE(without.is_valid());
  const auto short_json = nlohmann::json::parse(to_json(without));
  EXPECT_EQ(short_json["gates"]["G2"]["state"], "not checked");
  EXPECT_TRUE(short_json["quality"].is_null());
}

TEST(CheckReport, EveryViolationHasANameAndAGate) {
  for (int k = 0; k <= static_cast<int>(Violation::periodic_mismatch); ++k) {
    EXPECT_FALSE(to_string(static_cast<Violation>(k)).empty());
    EXPECT_FALSE(gate_of(static_cast<Violation>(k)).empty());
  }
}

TEST(Quality, StraightPrismsHaveNoSkewCollapsedColumnsDo) {
  constexpr double k_degree = std::numbers::pi / 180.0;
  const Quality straight = checked(plate_block(3)).quality;
  EXPECT_EQ(straight.skew_below_6, 1.0);
  EXPECT_EQ(straight.skew_above_60, 0.0);
  EXPECT_NEAR(straight.min_wedge_quality, 0.5, 0.5);
  EXPECT_GT(straight.min_wedge_quality, 0.1);
  EXPECT_GT(straight.min_dihedral, 5.0 * k_degree);
  EXPECT_LT(straight.max_dihedral, 175.0 * k_degree);

  const HybridMesh mesh = plate_block(2, {.collapsed = {4}});  // the middle vertex: 6 of 8 columns
  const Quality quality = checked(mesh).quality;
  const CellCounts counts = count_cells(mesh);
  EXPECT_NEAR(quality.skew_above_60, static_cast<double>(counts.pyramids) / static_cast<double>(counts.pyramids + counts.prisms), 1e-12);
}

TEST(Quality, SkewOfASlantedPrismIsItsSlant) {
  HybridMesh mesh = plate_block(2, {.n_layers = 1, .layer_height = 0.5});
  for (Point& p : mesh.points) p.x += p.z * std::tan(0.2);  // 11.5 degrees
  const Quality quality = checked(mesh).quality;
  EXPECT_EQ(quality.skew_below_6, 0.0);
  EXPECT_EQ(quality.skew_below_18, 1.0);
}

}  // namespace
}  // namespace sterna
