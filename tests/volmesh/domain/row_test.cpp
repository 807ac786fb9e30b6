// Wings and bars through two periodic sides, from exact models through surface meshes with matching borders to checked volume meshes.
#include <gmock/gmock.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "geom/mesh/periodic.h"
#include "geom/model/shapes.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/error_of.h"
#include "tests/support/rows.h"
#include "tests/support/test_constants.h"
#include "tests/volmesh/domain/room.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using test::k_context;
using testing::HasSubstr;

Model row_of(const Model& body) { return test::through_duct(std::array{body}, PatchKind::slip); }
Model blade(double trailing_edge) { return test::blade(trailing_edge, "0012", 0.05); }

TriMesh surface_of(const Model& body, const std::string& pairs, const RunContext& context, std::vector<Rule> rules = {}) {
  surfmesh::SurfaceMeshOptions options;
  options.sizes.max_edge = 0.15;
  options.sizes.min_edge = 0.015;
  options.sizes.curvature_angle = 0.4;
  options.sizes.growth = 1.5;
  options.periodic = side_pairs(pairs);
  return surfmesh::mesh_model(row_of(body), options, rules, context).mesh;
}

const std::string k_sides = "tunnel_left,tunnel_right";

MeshCase layers_between_sides(int n) {
  MeshCase options = layers(n, 1e-3);
  options.periodic = {{"tunnel_left", "tunnel_right"}};
  return options;
}

void expect_matched(const VolumeMeshResult& result, std::size_t n_pairs) {
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  ASSERT_EQ(result.mesh.periodic.size(), n_pairs);
  for (const PeriodicSides& sides : result.mesh.periodic) {
    const PeriodicMatch match = match_periodic(result.mesh, sides.first, sides.second, periodic_tolerance(result.mesh));
    EXPECT_LT(distance(match.translation, sides.translation), 1e-12);
    EXPECT_GT(match.nodes.size(), 50u);
  }
}

TEST(Row, BarThroughBothSidesFloorAndCeiling) {
  const TriMesh surface = surface_of(make_cylinder("bar", {0, -1, 0}, {0, 1, 0}, 0.25), k_sides + ";tunnel_floor,tunnel_ceiling", k_context);
  MeshCase options = layers_between_sides(8);
  options.periodic.push_back({"tunnel_floor", "tunnel_ceiling"});
  const VolumeMeshResult result = volume_mesh(surface, options, k_context);
  expect_matched(result, 2);
  const std::map<std::string, std::size_t> borders = border_edges(result);
  EXPECT_EQ(borders.at("tunnel_left"), borders.at("tunnel_right"));
  EXPECT_GE(borders.at("tunnel_left"), 16u);
}

TEST(Row, WingsWithSharpAndBluntTrailingEdges) {
  for (const double trailing_edge : {0.0, 0.012})
    expect_matched(volume_mesh(surface_of(blade(trailing_edge), k_sides, k_context), layers_between_sides(8), k_context), 1);
}

TEST(Row, SharpTrailingEdgesOpenFromSideToSide) {
  MeshCase options = layers_between_sides(8);
  options.ridges.open_ridges = "always";
  expect_matched(volume_mesh(surface_of(blade(0.0), k_sides, k_context), options, k_context), 1);
}

TEST(Row, WingEndingInTwoFarfieldPlanes) {
  Model model = row_of(blade(0.012));
  Column<FaceId, ModelFace> wing;
  for (const ModelFace& face : model.faces)
    if (face.name == "blade") wing.push_back(face);
  model.faces = std::move(wing);
  model.solids = {};
  surfmesh::SurfaceMeshOptions options;
  options.sizes.max_edge = 0.15;
  options.sizes.min_edge = 0.015;
  options.sizes.curvature_angle = 0.4;
  options.sizes.growth = 1.5;
  options.periodic = {{"symmetry_y_min", "symmetry_y_max"}};
  const TriMesh surface = surfmesh::mesh_model(model, options, {}, k_context).mesh;
  MeshCase given = layers(8, 1e-3);
  given.periodic = {{"symmetry_y_min", "symmetry_y_max"}};
  given.farfield.farfield_shape = "box";
  expect_matched(volume_mesh(surface, given, k_context), 1);
}

TEST(Row, AnyNumberOfThreadsGivesTheSame) {
  const auto made = [](int threads) {
    const RunContext context({.threads = threads});
    return volume_mesh(surface_of(blade(0.012), k_sides, context), layers_between_sides(6), context).mesh;
  };
  const HybridMesh one = made(1);
  for (const int threads : {2, 7}) {
    const HybridMesh other = made(threads);
    EXPECT_EQ(one.points.raw(), other.points.raw());
    EXPECT_EQ(one.tetrahedra, other.tetrahedra);
  }
}

TEST(Row, BordersDividedDifferentlyNameTheRemedy) {
  const TriMesh surface = surface_of(blade(0.012), "", k_context, {{.names = "tunnel_left", .options = {{"max_edge", 0.07}}}});
  const ErrorInfo error = test::error_info_of([&] { volume_mesh(surface, layers_between_sides(6), k_context); });
  EXPECT_EQ(error.code, ErrorCode::bad_argument);
  EXPECT_THAT(error.problem, HasSubstr("have no partner"));
  EXPECT_THAT(error.hint, HasSubstr("surface_mesh{ ..., periodic = { { \"tunnel_left\", \"tunnel_right\" } } }"));
}

}  // namespace
}  // namespace sterna::volmesh
